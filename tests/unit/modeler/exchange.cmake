limn_add_test(test_modeler_sketch
  SOURCES sketch_test.cpp sketch_curve_forms_test.cpp
  LINK limn_sketch LABEL unit)

limn_add_test(test_modeler_json
  SOURCES exchange_json_test.cpp
  LINK limn_sketch_json LABEL unit)

# STEP is read back with Open CASCADE itself.
find_path(LIMN_OCCT_INCLUDE STEPControl_Controller.hxx PATH_SUFFIXES opencascade)
if(LIMN_OCCT_INCLUDE)
  limn_add_test(test_modeler_step
    SOURCES exchange_step_test.cpp
    LINK limn_exchange TKSTEP TKXSBase TKBRep TKTopAlgo TKG3d TKMath TKernel LABEL unit)
  target_include_directories(test_modeler_step SYSTEM PRIVATE ${LIMN_OCCT_INCLUDE})
endif()

limn_add_test(test_modeler_picture
  SOURCES view_ink_test.cpp view_page_test.cpp view_svg_test.cpp
  LINK limn_picture LABEL unit)

# PNG is read back with cairo itself.
find_path(LIMN_CAIRO_INCLUDE cairo-pdf.h PATH_SUFFIXES cairo)
if(LIMN_CAIRO_INCLUDE)
  limn_add_test(test_modeler_cairo
    SOURCES view_cairo_test.cpp
    LINK limn_picture cairo LABEL unit)
  target_include_directories(test_modeler_cairo SYSTEM PRIVATE ${LIMN_CAIRO_INCLUDE})
endif()
