foreach(name descriptor_file evemu hid_recorder open stroke_csv usbhid_dump)
  limn_add_fuzz_target(trace_${name} SOURCE trace_${name}.cpp LINK limn_trace)
endforeach()
