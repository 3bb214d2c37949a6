limn_add_test(hid_property_test
  SOURCES hid_round_trip_test.cpp
  LINK limn_hid
  LABEL property)
