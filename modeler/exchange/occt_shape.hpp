#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/model/model.hpp"

// Models in Open CASCADE's terms. Both functions let its exceptions through.

namespace limn::exchange_detail {

/// A solid where the body is closed, else a shell. Error: kOutOfRange as model_to_step().
Expected<TopoDS_Shape> shape_of(const Body& body);

/// Error: kOutOfRange as model_to_step().
Expected<TopoDS_Shape> shape_of(const NamedCurve& curve);

/// Adds what is in a shape to `model`, and to `skipped` a line for what is not read.
void add_shape(const TopoDS_Shape& shape, Model& model, std::vector<std::string>& skipped);

}  // namespace limn::exchange_detail
