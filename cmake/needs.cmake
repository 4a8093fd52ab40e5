# Libraries that the build needs. All that are missing are named at once, with what they are for and Debian's package, from tools/packages.txt.
set(sunfleck_missing "")

# Appends the line of a missing library, by the name that tools/packages.txt has for it.
function(sunfleck_note_missing name)
  file(STRINGS ${PROJECT_SOURCE_DIR}/tools/packages.txt line REGEX "# ${name}: ")
  string(REGEX REPLACE "^([^ ]+) +# [^:]+: (.*)$" "\\2; Debian: \\1" about "${line}")
  set(sunfleck_missing "${sunfleck_missing}\n  ${name} ${ARGN}(${about})" PARENT_SCOPE)
endfunction()

# sunfleck_needs(NAME find_package's arguments...)
macro(sunfleck_needs name)
  find_package(${name} ${ARGN} QUIET)
  if(NOT ${name}_FOUND)
    set(wanted_version "")
    if("${ARGN}" MATCHES "^[0-9.]+")
      set(wanted_version "${CMAKE_MATCH_0} or later ")
    endif()
    sunfleck_note_missing(${name} ${wanted_version})
  endif()
endmacro()

# sunfleck_needs_pkg(PREFIX NAME): by pkg-config
macro(sunfleck_needs_pkg prefix name)
  if(PkgConfig_FOUND)
    pkg_check_modules(${prefix} QUIET IMPORTED_TARGET ${name})
  endif()
  if(NOT ${prefix}_FOUND)
    sunfleck_note_missing(${name})
  endif()
endmacro()

macro(sunfleck_say_missing)
  if(sunfleck_missing)
    message(FATAL_ERROR "missing, or too old:${sunfleck_missing}\n")
  endif()
endmacro()
