// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/xml/xml_document.h"
#include "common/model/kinematic_model.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

/// One `<RobotNode>`, not yet part of a tree: parents and marker segments are not set.
struct ModelNode {
  struct Child {
    std::string name;
    int line = 0;
  };

  Segment segment;
  int line = 0;
  std::vector<Child> children;
  std::vector<ModelMarker> markers;
};

/// Metres in the unit that an element of a model names for its lengths; mm where it names none that
/// is known.
double LengthUnit(const XmlElement& element);

/// Problems go to `diagnostics`; what could not be read keeps its default.
ModelNode ReadModelNode(const XmlElement& element, Diagnostics& diagnostics);

}  // namespace mmm_converter
