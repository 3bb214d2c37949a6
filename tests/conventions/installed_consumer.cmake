# One step of the test of the installed package, as a script: STEP is install, find_package or
# pkg_config; BUILD the build folder to install from, WORK a folder to work in, SOURCE the consumer.

set(prefix ${WORK}/prefix)
set(flags)
if(SANITIZE)  # the archives hold calls into the sanitizers' runtime
  set(flags -fsanitize=${SANITIZE})
endif()

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

if(STEP STREQUAL install)
  file(REMOVE_RECURSE ${WORK})
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
elseif(STEP STREQUAL find_package)
  run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
      -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${flags})
  run(${CMAKE_COMMAND} --build ${WORK}/build)
  run(${WORK}/build/consumer)
  run(${WORK}/build/backends ${WORK}/build)
elseif(STEP STREQUAL pkg_config)
  find_program(PKG_CONFIG NAMES pkg-config pkgconf REQUIRED)
  set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
  foreach(program consumer backends)
    # Pictures and STEP are what the libraries need others for, so only they ask for --static.
    set(static)
    if(program STREQUAL backends)
      set(static --static)
    endif()
    execute_process(COMMAND ${PKG_CONFIG} ${static} --cflags --libs limn
      OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(found UNIX_COMMAND "${found}")
    run(${COMPILER} -std=c++20 ${flags} ${SOURCE}/${program}.cpp ${found} -o ${WORK}/${program})
    run(${WORK}/${program} ${WORK})
  endforeach()
else()
  message(FATAL_ERROR "no such step: ${STEP}")
endif()
