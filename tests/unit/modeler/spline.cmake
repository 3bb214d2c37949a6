limn_add_test(unit_modeler_bspline
  SOURCES bspline_knot_vector_test.cpp bspline_control_point_map_test.cpp
          bspline_tensor_spline_test.cpp
  LINK limn_bspline
  LABEL unit)

limn_add_test(unit_modeler_fit
  SOURCES fit_banded_system_test.cpp fit_knot_placement_test.cpp fit_curve_test.cpp
          fit_strokes_test.cpp
  LINK limn_fit
  LABEL unit)
