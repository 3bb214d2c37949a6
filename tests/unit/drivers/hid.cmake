limn_add_test(hid_test
  SOURCES hid_descriptor_parser_test.cpp hid_field_reader_test.cpp hid_layout_test.cpp
          hid_limits_test.cpp hid_units_test.cpp hid_describe_test.cpp hid_usages_test.cpp
          hid_real_descriptors_test.cpp
  LINK limn_hid limn_alloc_guard
  LABEL unit)
