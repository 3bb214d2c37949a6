# The build's own vocabulary: one function a kind of target. No globs, no downloads.

set(LIMN_WARNINGS
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wdouble-promotion -Wformat=2 -Wcast-align
  -Wimplicit-fallthrough)

# Flags every target of limn gets, libraries and tests alike. -ffp-contract=off gives the same bits
# on every compiler: no fused multiply-add appears where the source has none.
function(limn_set_flags target)
  target_compile_options(${target} PRIVATE ${LIMN_WARNINGS} -ffp-contract=off)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    # Small programs can leave out what they do not call (-Wl,--gc-sections).
    target_compile_options(${target} PRIVATE -ffunction-sections -fdata-sections)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 sees overlaps in std::string's own code at -O2 and -O3 (GCC bug 105651).
    # On 32-bit Arm it tells that GCC 7 passed some arguments otherwise.
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-psabi)
  endif()
  if(LIMN_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(LIMN_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${LIMN_SANITIZE} -fno-sanitize-recover=all
                                             -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${LIMN_SANITIZE})
    if(LIMN_SANITIZE MATCHES undefined AND NOT LIMN_FUZZ)
      # Half of GCC's time goes into these two checks. A null access stops the program in any case;
      # the fuzz preset, which clang builds, keeps both.
      target_compile_options(${target} PRIVATE -fno-sanitize=null,alignment)
    endif()
  endif()
  if(LIMN_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

# What most sources include.
set(LIMN_STANDARD_HEADERS <algorithm> <array> <cmath> <cstdint> <memory> <optional> <span> <string>
                          <string_view> <utility> <vector>)

# limn_precompile(TARGET SET HEADERS ..): parses the headers once for all targets of one SET, where
# LIMN_PRECOMPILE is on. The release and clang presets do without, so that no source comes to need it.
function(limn_precompile target set)
  if(NOT LIMN_PRECOMPILE)
    return()
  endif()
  get_property(first GLOBAL PROPERTY LIMN_PRECOMPILED_${set})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
    set_property(GLOBAL PROPERTY LIMN_PRECOMPILED_${set} ${target})
  endif()
endfunction()

# limn_leave_unoptimized(SOURCES ..): in debug builds, where the optimiser would take longest.
function(limn_leave_unoptimized)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS $<$<CONFIG:Debug>:-O0> SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# limn_add_library(NAME SOURCES .. HEADERS .. LINK .. LINK_PRIVATE ..)
#
# Makes the static library limn_NAME, known to users as limn::NAME. HEADERS are public: each must
# compile by itself (verified where CMAKE_VERIFY_INTERFACE_HEADER_SETS is on) and is installed under
# its path from the repository root. LINK holds what the public headers include, LINK_PRIVATE what
# only the sources include.
function(limn_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;LINK;LINK_PRIVATE" ${ARGN})
  set(target limn_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    limn_set_flags(${target})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(limn::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
                                             FILES ${ARG_HEADERS})
  target_link_libraries(${target} ${scope} ${ARG_LINK})
  if(ARG_SOURCES)
    limn_precompile(${target} standard ${LIMN_STANDARD_HEADERS})
  endif()
  if(ARG_LINK_PRIVATE)
    target_link_libraries(${target} PRIVATE ${ARG_LINK_PRIVATE})
  endif()
  install(TARGETS ${target} EXPORT limnTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limn)
  set_property(GLOBAL APPEND PROPERTY LIMN_LIBRARIES ${target})
endfunction()

# limn_add_test(NAME SOURCES .. LINK ..): one GoogleTest binary, one ctest entry a test case, with the
# first word of NAME (unit, property, ..) as its label. A test that calls GTEST_SKIP prints its reason
# and counts as skipped.
function(limn_add_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  limn_set_flags(${name})
  # A test names enumerators of absent members often; conversions in its literals are no defects.
  target_compile_options(${name} PRIVATE -Wno-conversion -Wno-sign-conversion
                                         -Wno-double-promotion)
  # Assertions are most of a test's code and need no optimiser: half the time to compile.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Debug>:-O0>)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} limn_test_support GTest::gmock
                                        GTest::gtest_main)
  limn_precompile(${name} tests ${PROJECT_SOURCE_DIR}/tests/support/precompiled.hpp)
  string(REGEX REPLACE "_.*" "" label ${name})
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${label} SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
endfunction()

# limn_add_fuzz_target(NAME SOURCE .. LINK ..)
#
# With LIMN_FUZZ a libFuzzer binary; otherwise the same target with a plain main that replays
# tests/fuzz/corpus/NAME, so that no target can rot.
function(limn_add_fuzz_target name)
  cmake_parse_arguments(ARG "" "SOURCE" "LINK" ${ARGN})
  set(target fuzz_${name})
  if(LIMN_FUZZ)
    add_executable(${target} ${ARG_SOURCE})
    target_link_options(${target} PRIVATE -fsanitize=fuzzer)
  else()
    add_executable(${target} ${ARG_SOURCE} ${PROJECT_SOURCE_DIR}/tests/fuzz/replay_main.cpp)
    add_test(NAME fuzz_${name}
             COMMAND ${target} ${PROJECT_SOURCE_DIR}/tests/fuzz/corpus/${name})
    set_tests_properties(fuzz_${name} PROPERTIES LABELS fuzz)
  endif()
  limn_set_flags(${target})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE ${ARG_LINK})
  set_property(GLOBAL APPEND PROPERTY LIMN_FUZZ_TARGETS ${name})
endfunction()

# The libraries in an order for static linking, each before those it needs.
function(limn_link_order out)
  get_property(left GLOBAL PROPERTY LIMN_LIBRARIES)
  set(ordered)
  while(left)
    set(postponed)
    foreach(target IN LISTS left)
      limn_direct_needs(${target} needs)
      list(FILTER needs INCLUDE REGEX "^limn_")
      list(REMOVE_ITEM needs ${ordered})
      if(needs)
        list(APPEND postponed ${target})
      else()
        list(PREPEND ordered ${target})
      endif()
    endforeach()
    if(postponed STREQUAL left)
      message(FATAL_ERROR "limn: these libraries need each other, or one that is not there: ${left}")
    endif()
    set(left ${postponed})
  endwhile()
  set(${out} ${ordered} PARENT_SCOPE)
endfunction()

# What `target` links, public or private, by plain names.
function(limn_direct_needs target out)
  get_target_property(needs ${target} INTERFACE_LINK_LIBRARIES)
  if(NOT needs)
    set(needs)
  endif()
  list(TRANSFORM needs REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1")
  list(TRANSFORM needs REPLACE "^limn::" "limn_")
  set(${out} ${needs} PARENT_SCOPE)
endfunction()

# Writes limn.pc. Plain --libs gives limn's own archives: enough for a program that uses no backend.
# --static adds what the backends (pictures, STEP) link.
function(limn_configure_pkg_config file)
  limn_link_order(libraries)
  set(libs)
  set(libs_private)
  set(requires)
  foreach(target IN LISTS libraries)
    get_target_property(type ${target} TYPE)
    if(NOT type STREQUAL INTERFACE_LIBRARY)
      string(APPEND libs " -l${target}")
    endif()
    limn_direct_needs(${target} needs)
    list(FILTER needs EXCLUDE REGEX "^limn_")
    foreach(need IN LISTS needs)
      if(need STREQUAL "Eigen3::Eigen")
        list(APPEND requires eigen3)
      elseif(need STREQUAL "Threads::Threads")
        list(APPEND libs_private -pthread)
      elseif(need MATCHES "::")
        message(FATAL_ERROR "limn: limn.pc has no word for ${need}, which ${target} links")
      else()
        list(APPEND libs_private -l${need})
      endif()
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES libs_private)
  list(REMOVE_DUPLICATES requires)
  list(JOIN libs_private " " libs_private)
  list(JOIN requires ", " requires)
  # Relative, so that an installed tree may be moved.
  file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(${PROJECT_SOURCE_DIR}/input/base/limn.pc.in ${file} @ONLY)
endfunction()

# find_package(limn), with the libraries as components, and one pkg-config file for all of them.
function(limn_install_package)
  install(EXPORT limnTargets NAMESPACE limn:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/limn)
  configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/input/base/limnConfig.cmake.in
    ${PROJECT_BINARY_DIR}/limnConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/limn)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/limnConfigVersion.cmake
    VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/limnConfig.cmake ${PROJECT_BINARY_DIR}/limnConfigVersion.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/limn)
  limn_configure_pkg_config(${PROJECT_BINARY_DIR}/limn.pc)
  install(FILES ${PROJECT_BINARY_DIR}/limn.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
