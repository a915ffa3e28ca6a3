// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_edit.h"

#include <fmt/format.h>

#include "common/io/osim/osim_values.h"
#include "common/io/osim/osim_xml.h"
#include "common/support/error.h"

namespace mmm_converter {

using Eigen::Vector3d;

namespace {

/// An object that is a property, as FindOsimObject.
XmlPlace FindObject(const XmlPlace& owner, std::string_view property) {
  const XmlElement* found = FindOsimObject(owner.element(), property);
  for (const XmlPlace& child : owner.Children()) {
    if (&child.element() == found) return child;
    for (const XmlPlace& inner : child.Children()) {
      if (&inner.element() == found) return inner;
    }
  }
  return {};
}

}  // namespace

std::string OsimVectorText(const Vector3d& v) {
  return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}

OsimEdit::OsimEdit(std::string_view content, const std::string& file)
    : rest_(content.substr(FirstElement(content).size())),
      diagnostics_(file),
      document_(ParseOsim(content, {}, &diagnostics_)),
      edit_(FirstElement(content), file),
      model_(edit_.root().Child("Model")),
      frames_(&diagnostics_) {
  for (const XmlElement& set : model_.element().children) {
    const std::string* part = set.FindAttribute("file");
    if (part == nullptr || part->empty()) continue;
    throw Error(
        fmt::format("{}:{}: <{}> stands in another file, {:.80}; only a model that is one "
                    "file can be scaled: open it in OpenSim and save it",
                    file, set.line, set.name, *part));
  }
  frames_.AddModel(model_.element());
}

std::vector<XmlPlace> OsimEdit::Objects(const XmlPlace& owner, std::string_view set) {
  return owner.Child(set).Child("objects").Children();
}

OsimFrames::Place OsimEdit::FrameAt(const std::string& owner, std::string_view socket, int line) {
  const auto place = frames_.Find(owner, socket, line, owner);
  diagnostics_.ThrowIfErrors();
  return *place;
}

OsimFrames::Place OsimEdit::FrameOf(const std::string& owner, const XmlElement& object) {
  const XmlElement* body = object.FindChild("body");
  return FrameAt(owner, body != nullptr ? body->text : OsimText(object, "socket_parent_frame"),
                 object.line);
}

double OsimEdit::Number(const XmlElement& object, std::string_view property, double otherwise) {
  return ReadOsimNumber(object, property, otherwise, &diagnostics_);
}

Vector3d OsimEdit::Vector(const XmlElement& object, std::string_view property,
                          const Vector3d& otherwise) {
  return ReadOsimVector(object, property, otherwise, &diagnostics_);
}

void OsimEdit::SetNumber(const XmlPlace& owner, const std::string& property, double before,
                         double value) {
  if (value != before) edit_.SetProperty(owner, property, fmt::format("{}", value));
}

void OsimEdit::SetVector(const XmlPlace& owner, const std::string& property, const Vector3d& before,
                         const Vector3d& value) {
  if (value != before) edit_.SetProperty(owner, property, OsimVectorText(value));
}

void OsimEdit::ScaleNumber(const XmlPlace& owner, const std::string& property, double factor) {
  const double value = Number(owner.element(), property, 0);
  SetNumber(owner, property, value, factor * value);
}

void OsimEdit::ScaleVector(const XmlPlace& owner, const std::string& property,
                           const Vector3d& factors) {
  const Vector3d value = Vector(owner.element(), property, Vector3d::Zero());
  SetVector(owner, property, value, factors.cwiseProduct(value));
}

void OsimEdit::ScaleFunction(const XmlPlace& owner, const std::string& property, double factor) {
  const XmlPlace function = FindObject(owner, property);
  if (!function || factor == 1) return;
  if (function.element().Is("Constant")) return ScaleNumber(function, "value", factor);
  if (function.element().Is("MultiplierFunction")) {
    const double scale = Number(function.element(), "scale", 1);
    return SetNumber(function, "scale", scale, factor * scale);
  }
  const std::string behind = fmt::format("<scale>{}</scale></MultiplierFunction>", factor);
  if (OsimName(function.element()) == property) {
    edit_.Wrap(function, fmt::format("<MultiplierFunction name=\"{}\"><function>", property),
               "</function>" + behind);
  } else {
    edit_.Wrap(function, "<MultiplierFunction><function>", "</function>" + behind);
  }
}

std::string OsimEdit::Finish() {
  diagnostics_.ThrowIfErrors();
  return edit_.Finish().append(rest_);
}

}  // namespace mmm_converter
