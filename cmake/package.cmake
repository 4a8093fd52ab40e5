# What `cmake --install` and `cpack` put together: the program, one shared library with its headers for find_package(sunfleck) and
# pkg-config, man page, completion, scenes and policies. All paths are relative to the prefix, which may be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# sunfleck_reachable(OUT HEADER): HEADER and all public headers that it includes, relative to include/
function(sunfleck_reachable out header)
  set(found "")
  set(waiting ${header})
  while(waiting)
    list(POP_FRONT waiting next)
    if(next IN_LIST found)
      continue()
    endif()
    list(APPEND found ${next})
    file(STRINGS ${PROJECT_SOURCE_DIR}/include/${next} lines REGEX "^#include [<\"]")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include [<\"]([^>\"]+)[>\"].*" "\\1" included "${line}")
      if(included MATCHES "^sunfleck/")
        list(APPEND waiting ${included})
      elseif(included MATCHES "/" AND NOT included MATCHES "^glm/")
        message(FATAL_ERROR "include/${next}: found #include <${included}>; expected headers of the standard library, of GLM and of Sunfleck alone, "
                            "since <${header}> reaches it and is installed")
      endif()
    endforeach()
  endwhile()
  list(SORT found)
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# sunfleck_below(MODULE): sets modules and libraries of the caller to the module, those below it, and what they link
macro(sunfleck_below module)
  if(NOT ${module} IN_LIST modules)
    list(APPEND modules ${module})
    get_target_property(links_${module} ${module} LINK_LIBRARIES)
    foreach(linked ${links_${module}})
      if(linked MATCHES "^sunfleck_")
        sunfleck_below(${linked})
      else()
        list(APPEND libraries ${linked})
      endif()
    endforeach()
  endif()
endmacro()

# sunfleck_version_script(FILE HEADERS...): exports what the headers declare in namespace sunfleck, by the first name after it in the
# mangled one, and nothing else: no other module, no other library.
function(sunfleck_version_script file)
  set(names "")
  foreach(header ${ARGN})
    file(READ ${PROJECT_SOURCE_DIR}/include/${header} text)
    string(REGEX REPLACE "//[^\n]*|(class|struct) [A-Za-z_0-9]+;" "" text "${text}")  # comments, and what is only named
    string(REGEX MATCHALL "(class|struct) [A-Za-z_0-9]+|[A-Za-z_][A-Za-z_0-9]*\\(" found "${text}")
    list(APPEND names ${found})
  endforeach()
  list(TRANSFORM names REPLACE "^(class|struct) |\\($" "")
  list(REMOVE_DUPLICATES names)
  list(SORT names)
  set(patterns "")
  foreach(name ${names})
    string(LENGTH ${name} length)
    string(APPEND patterns "    _ZN8sunfleck${length}${name}*;\n    _ZNK8sunfleck${length}${name}*;\n    _ZT?N8sunfleck${length}${name}E;\n")
  endforeach()
  file(CONFIGURE OUTPUT ${file} CONTENT "{\n  global:\n${patterns}  local: *;\n};\n" @ONLY)
endfunction()

sunfleck_reachable(installed_headers sunfleck/sunfleck.hpp)
set(version_script ${PROJECT_BINARY_DIR}/package/sunfleck.map)
sunfleck_version_script(${version_script} ${installed_headers})
foreach(header ${installed_headers})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS include/${header})
endforeach()

# The library: the objects of the solver and of all modules below it.
set(modules "")
set(libraries "")
sunfleck_below(sunfleck_solver)
list(REMOVE_DUPLICATES libraries)
set(objects "")
foreach(module ${modules})
  get_target_property(type ${module} TYPE)
  if(NOT type STREQUAL INTERFACE_LIBRARY)
    list(APPEND objects $<TARGET_OBJECTS:${module}>)
  endif()
endforeach()
add_library(sunfleck_shared SHARED ${objects})
set_target_properties(sunfleck_shared PROPERTIES OUTPUT_NAME sunfleck EXPORT_NAME sunfleck VERSION ${PROJECT_VERSION} LINKER_LANGUAGE CXX
                      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LINK_DEPENDS ${version_script})
target_link_libraries(sunfleck_shared PRIVATE ${libraries} INTERFACE glm::glm)
target_link_options(sunfleck_shared PRIVATE -Wl,--version-script=${version_script} -Wl,--no-undefined)
target_include_directories(sunfleck_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(sunfleck_shared INTERFACE cxx_std_20)

install(TARGETS sunfleck_shared EXPORT sunfleckTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(header ${installed_headers})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES include/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
endforeach()
configure_file(cmake/version.hpp.in package/version.hpp @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sunfleck)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/sunfleck)
install(EXPORT sunfleckTargets NAMESPACE sunfleck:: DESTINATION ${config_folder})
configure_package_config_file(cmake/sunfleckConfig.cmake.in package/sunfleckConfig.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/sunfleckConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/sunfleckConfig.cmake ${PROJECT_BINARY_DIR}/package/sunfleckConfigVersion.cmake DESTINATION ${config_folder})

file(RELATIVE_PATH up_to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" up_to_prefix ${up_to_prefix})
configure_file(cmake/sunfleck.pc.in package/sunfleck.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/sunfleck.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The program, and what its user reads.
install(TARGETS sunfleck RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY policies plants DESTINATION ${CMAKE_INSTALL_DATADIR}/sunfleck)
install(FILES README.md LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
set(man_page ${PROJECT_BINARY_DIR}/package/sunfleck.1)
add_custom_command(OUTPUT ${man_page}
                   COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:sunfleck> -DVERSION=${PROJECT_VERSION} -DOUTPUT=${man_page}
                           -P ${PROJECT_SOURCE_DIR}/cmake/man_page.cmake
                   DEPENDS sunfleck cmake/man_page.cmake VERBATIM)
add_custom_target(sunfleck_man ALL DEPENDS ${man_page})
install(FILES ${man_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES packaging/sunfleck.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME sunfleck)
install(FILES packaging/_sunfleck DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)

# The Debian package: cpack finds the libraries that it depends on (dpkg-shlibdeps).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sunfleck)
set(CPACK_PACKAGE_CONTACT "The Sunfleck developers <sunfleck@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "light shared out in plants, per leaf and spectral band")
set(CPACK_PACKAGE_DESCRIPTION "Sunfleck computes the light that every leaf of a plant, crop or forest receives and absorbs: radiosity
along lines, with copies of plants that share what is alike, and a path-traced certificate of its error.
It holds the program, and the C++ library with its headers.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS fonts-dejavu-core)  # text on pictures
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libglm-dev, pkgconf, cmake, g++")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
