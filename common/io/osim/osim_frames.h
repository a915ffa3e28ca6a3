// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

/// The frames of a model of version 4: bodies, and offset frames that hang on them or on each
/// other, found by paths ("/bodyset/pelvis", "pelvis_offset", "..") as OpenSim finds them.
class OsimFrames {
 public:
  /// A frame fixed to a body.
  struct Place {
    int body = 0;
    Eigen::Isometry3d X_BF = Eigen::Isometry3d::Identity();  ///< [m]
  };

  explicit OsimFrames(Diagnostics* diagnostics) : diagnostics_(diagnostics) {}

  void AddBody(const std::string& path, int body);
  /// A PhysicalOffsetFrame that belongs to the component of that path.
  void AddOffsetFrame(const std::string& owner, const XmlElement& frame);
  /// The offset frames among the elements of a list that is a property (`components`, `frames`).
  void AddOffsetFrames(const std::string& owner, const XmlElement& object, std::string_view list);

  /// Bodies, numbered as OsimDocument numbers them, and offset frames of a model, of any version,
  /// that has all of its sets in its file.
  void AddModel(const XmlElement& model);

  /// The frame that a socket of the component `owner` names; nothing, and an error, where there is
  /// none. what: the socket's owner for the message.
  std::optional<Place> Find(const std::string& owner, std::string_view socket, int line,
                            const std::string& what);

 private:
  struct Frame {
    int body = -1;       // a body; or
    std::string path;    // of an offset frame
    std::string parent;  // its socket
    int line = 0;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();  // in the parent
  };

  int Look(const std::string& owner, std::string_view socket) const;

  Diagnostics* diagnostics_;
  std::vector<Frame> frames_;
  std::map<std::string, int> by_path_;
  std::map<std::string, int, std::less<>> body_by_name_;
};

}  // namespace mmm_converter
