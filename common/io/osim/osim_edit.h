// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/osim/osim_document.h"
#include "common/io/osim/osim_frames.h"
#include "common/io/xml/xml_edit.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

/// A model's text that is being changed, with what it says.
class OsimEdit {
 public:
  /// @throws Error as ParseOsim, and where a set of the model stands in a file of its own.
  OsimEdit(std::string_view content, const std::string& file);

  const OsimDocument& document() const { return document_; }
  XmlPlace model() const { return model_; }
  XmlEdit& edit() { return edit_; }
  Diagnostics* diagnostics() { return &diagnostics_; }
  /// The objects of a set of the model, or of one that is a property of an object.
  static std::vector<XmlPlace> Objects(const XmlPlace& owner, std::string_view set);

  /// The frame that the object hangs on by its socket (4.x) or `body` (before). @throws Error
  OsimFrames::Place FrameOf(const std::string& owner, const XmlElement& object);
  OsimFrames::Place FrameAt(const std::string& owner, std::string_view socket, int line);

  double Number(const XmlElement& object, std::string_view property, double otherwise);
  Eigen::Vector3d Vector(const XmlElement& object, std::string_view property,
                         const Eigen::Vector3d& otherwise);
  /// Where it differs from what is there.
  void SetNumber(const XmlPlace& owner, const std::string& property, double before, double value);
  void SetVector(const XmlPlace& owner, const std::string& property, const Eigen::Vector3d& before,
                 const Eigen::Vector3d& value);
  /// Multiplies what is there; what is not there is 0.
  void ScaleNumber(const XmlPlace& owner, const std::string& property, double factor);
  void ScaleVector(const XmlPlace& owner, const std::string& property,
                   const Eigen::Vector3d& factors);
  /// A function that is a property, as OpenSim does it: inside a MultiplierFunction.
  void ScaleFunction(const XmlPlace& owner, const std::string& property, double factor);

  /// @throws Error where a number was none.
  std::string Finish();

 private:
  std::string_view rest_;  // behind the root
  Diagnostics diagnostics_;
  OsimDocument document_;
  XmlEdit edit_;
  XmlPlace model_;
  OsimFrames frames_;
};

/// x y z, with as many digits as each needs.
std::string OsimVectorText(const Eigen::Vector3d& v);

}  // namespace mmm_converter
