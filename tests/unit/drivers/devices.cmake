limn_add_test(devices_test
  SOURCES devices_table_test.cpp devices_wacom_test.cpp devices_wacom_intuos_test.cpp
          devices_generic_test.cpp devices_evdev_test.cpp devices_trace_decoder_test.cpp
          devices_allocation_test.cpp
  LINK limn_devices limn_alloc_guard
  LABEL unit)

limn_add_test(devices_recordings_test
  SOURCES devices_recordings_test.cpp devices_kernel_oracle_test.cpp
  LINK limn_devices
  LABEL unit)
