# Compiles SOURCES (from ROOT) with COMPILER FLAGS, without exceptions and RTTI, into WORK, and looks
# with NM whether an object needs what a microcontroller does not have: a heap, exceptions, type
# information, or locks around static locals.
if(NOT COMPILER OR NOT NM)
  execute_process(COMMAND ${CMAKE_COMMAND} -E echo
    "skipped: no arm-none-eabi-g++ (apt install gcc-arm-none-eabi libstdc++-arm-none-eabi-newlib)")
  return()
endif()
if(NOT SOURCES)
  message(FATAL_ERROR "no sources to look at")
endif()

file(MAKE_DIRECTORY ${WORK})
set(forbidden "_Zn[wa]|_Zd[la]|malloc|calloc|realloc|free|__cxa_throw|__cxa_begin_catch|\
__cxa_allocate_exception|__cxa_guard_acquire|__dynamic_cast|_ZTI[^N]|_Unwind_Resume")
set(checked 0)
foreach(source IN LISTS SOURCES)
  string(MAKE_C_IDENTIFIER ${source} name)
  set(object ${WORK}/${name}.o)
  execute_process(
    COMMAND ${COMPILER} -std=c++20 ${FLAGS} -Os -fno-exceptions -fno-rtti -ffp-contract=off
            -Wall -Wextra -Werror -I${ROOT} -c ${ROOT}/${source} -o ${object}
    RESULT_VARIABLE failed ERROR_VARIABLE errors)
  if(failed)
    message(FATAL_ERROR "${source} does not compile:\n${errors}")
  endif()
  execute_process(COMMAND ${NM} --undefined-only ${object} OUTPUT_VARIABLE needed
                  COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[ \t](${forbidden})[^\n]*" found "${needed}")
  if(found)
    message(FATAL_ERROR "${source} needs${found}")
  endif()
  math(EXPR checked "${checked} + 1")
endforeach()
message(STATUS "${checked} sources need no heap, exceptions or RTTI")
