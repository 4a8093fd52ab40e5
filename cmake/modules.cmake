# One library target per module: sunfleck_M from src/M/*.cpp with public headers in include/sunfleck/M.

# -Wno-restrict: g++ 12 sees overlaps in "text" + std::string that are not there (GCC bug 105651).
function(sunfleck_options target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-restrict -Werror)
  endif()
  if(CMAKE_UNITY_BUILD)  # files are compiled together: each one's private names stand in sight of the others'
    target_compile_options(${target} PRIVATE -Wno-shadow)
  endif()
  target_compile_options(${target} PRIVATE -fno-math-errno -fno-trapping-math)  # lets loops with rounding be vectorised; changes no result
  if(SUNFLECK_ISA)
    target_compile_options(${target} PRIVATE -march=${SUNFLECK_ISA})
  endif()
  if(SUNFLECK_CONTRACT)
    target_compile_options(${target} PRIVATE -ffp-contract=fast)
  else()
    target_compile_options(${target} PRIVATE -ffp-contract=off)
  endif()
  if(SUNFLECK_FUZZ)
    target_compile_options(${target} PUBLIC -fsanitize=fuzzer-no-link,address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
  if(SUNFLECK_SANITIZE)
    # float-cast-overflow: a number beyond its integer type is undefined behaviour too, but not part of GCC's "undefined"
    target_compile_options(${target} PUBLIC -fsanitize=address,undefined,float-cast-overflow -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)  # g++ 12 sees some in instrumented libraries' headers that are none
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
  if(SUNFLECK_THREAD_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=thread)
    target_link_options(${target} PUBLIC -fsanitize=thread)
  endif()
endfunction()

# sunfleck_module(NAME LINK public... PRIVATE private...)
function(sunfleck_module name)
  cmake_parse_arguments(M "" "" "LINK;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  if(NOT sources)  # a module of headers only
    add_library(sunfleck_${name} INTERFACE)
    target_include_directories(sunfleck_${name} INTERFACE ${PROJECT_SOURCE_DIR}/include)
    target_link_libraries(sunfleck_${name} INTERFACE ${M_LINK})
    return()
  endif()
  add_library(sunfleck_${name} STATIC ${sources})
  target_include_directories(sunfleck_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(sunfleck_${name} PUBLIC ${M_LINK} PRIVATE ${M_PRIVATE})
  if(SUNFLECK_INSTALL OR SUNFLECK_PYTHON)  # for the shared library and the Python module; calls within it are inlined as they are in programs
    set_target_properties(sunfleck_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_options(sunfleck_${name} PRIVATE -fno-semantic-interposition)
  endif()
  sunfleck_options(sunfleck_${name})
endfunction()

# sunfleck_embed(NAME FOLDER): the files of a folder become part of the module, in a C++ file that is made anew when one of them changes.
function(sunfleck_embed name folder)
  file(GLOB files CONFIGURE_DEPENDS ${folder}/*)
  set(output ${PROJECT_BINARY_DIR}/embedded/${name}_files.cpp)
  add_custom_command(OUTPUT ${output}
                     COMMAND ${CMAKE_COMMAND} -DSOURCE=${folder} -DOUTPUT=${output} -P ${PROJECT_SOURCE_DIR}/cmake/embed_web_files.cmake
                     DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/embed_web_files.cmake VERBATIM)
  target_sources(sunfleck_${name} PRIVATE ${output})
endfunction()

# sunfleck_leave_out(NAME FILE PATTERN): the module's sources of that pattern are not compiled; src/NAME/absent/FILE is in their place.
function(sunfleck_leave_out name file pattern)
  get_target_property(sources sunfleck_${name} SOURCES)
  list(FILTER sources EXCLUDE REGEX "/src/${name}/${pattern}$")
  set_property(TARGET sunfleck_${name} PROPERTY SOURCES ${sources} ${PROJECT_SOURCE_DIR}/src/${name}/absent/${file})
endfunction()
