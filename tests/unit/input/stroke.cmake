limn_add_test(stroke_test
  SOURCES stroke_sampler_test.cpp stroke_pen_state_machine_test.cpp
  LINK limn_stroke limn_alloc_guard
  LABEL unit)
