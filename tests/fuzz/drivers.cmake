limn_add_fuzz_target(hid_descriptor SOURCE hid_descriptor.cpp LINK limn_hid)
limn_add_fuzz_target(hid_extraction SOURCE hid_extraction.cpp LINK limn_hid)
