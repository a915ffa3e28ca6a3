// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/io/osim/osim_values.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMostFrames = 65536;
// Offset frames may hang on offset frames; those of real models do so once.
constexpr int kLongestChain = 64;

/// An absolute path without "." and "..".
std::string Normal(std::string_view path) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at < path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    const std::string_view part = path.substr(at, end - at);
    if (part == "..") {
      if (!parts.empty()) parts.pop_back();
    } else if (!part.empty() && part != ".") {
      parts.push_back(part);
    }
    at = end + 1;
  }
  std::string normal;
  for (const std::string_view part : parts) normal.append("/").append(part);
  return normal;
}

}  // namespace

void OsimFrames::AddBody(const std::string& path, int body) {
  by_path_.emplace(path, static_cast<int>(frames_.size()));
  body_by_name_.emplace(path.substr(path.rfind('/') + 1), static_cast<int>(frames_.size()));
  Frame& frame = frames_.emplace_back();
  frame.body = body;
  frame.path = path;
}

void OsimFrames::AddOffsetFrame(const std::string& owner, const XmlElement& element) {
  if (frames_.size() >= kMostFrames) {
    throw Error(fmt::format("{}: has more than the {} frames that are read", diagnostics_->file(),
                            kMostFrames));
  }
  const int index = static_cast<int>(frames_.size());
  Frame& frame = frames_.emplace_back();
  frame.path = owner + "/" + OsimName(element);
  frame.parent = std::string(OsimText(element, "socket_parent"));
  frame.line = element.line;
  frame.X = ReadOsimPose(element, "translation", "orientation", diagnostics_);
  const std::string path = frame.path;
  by_path_.emplace(path, index);
  AddOffsetFrames(path, element, "components");
}

void OsimFrames::AddOffsetFrames(const std::string& owner, const XmlElement& object,
                                 std::string_view list) {
  const XmlElement* elements = object.FindChild(list);
  if (elements == nullptr) return;
  for (const XmlElement& element : elements->children) {
    if (element.Is("PhysicalOffsetFrame")) AddOffsetFrame(owner, element);
  }
}

void OsimFrames::AddModel(const XmlElement& model) {
  AddBody("/ground", 0);
  if (const XmlElement* ground = model.FindChild("Ground")) {
    AddOffsetFrames("/ground", *ground, "components");
  }
  AddOffsetFrames("", model, "components");
  int bodies = 0;
  const auto for_each = [&model](const char* set, const auto& visit) {
    const XmlElement* objects = FindOsimObjects(model, set);
    if (objects != nullptr)
      std::for_each(objects->children.begin(), objects->children.end(), visit);
  };
  for_each("BodySet", [&](const XmlElement& body) {
    if (OsimName(body) == "ground") return;
    AddBody("/bodyset/" + OsimName(body), ++bodies);
    AddOffsetFrames("/bodyset/" + OsimName(body), body, "components");
  });
  for_each("JointSet", [&](const XmlElement& joint) {
    AddOffsetFrames("/jointset/" + OsimName(joint), joint, "frames");
  });
  for_each("ComponentSet", [&](const XmlElement& one) {
    if (one.Is("PhysicalOffsetFrame")) AddOffsetFrame("/componentset", one);
  });
}

int OsimFrames::Look(const std::string& owner, std::string_view socket) const {
  const std::string text(socket);
  const std::string parent = owner.substr(0, owner.rfind('/'));
  // As it is meant; then as files of the first 4.0 have it, with the model's name in front.
  for (const std::string& path :
       {socket.front() == '/' ? Normal(text) : Normal(owner + "/" + text),
        Normal(parent + "/" + text), Normal("/" + text), Normal("/bodyset/" + text)}) {
    if (const auto found = by_path_.find(path); found != by_path_.end()) return found->second;
  }
  if (socket.front() == '/' && socket.find('/', 1) != std::string_view::npos) {
    const auto found = by_path_.find(Normal(text.substr(text.find('/', 1))));
    if (found != by_path_.end()) return found->second;
  }
  const auto found = body_by_name_.find(socket.substr(socket.rfind('/') + 1));
  return found == body_by_name_.end() ? -1 : found->second;
}

std::optional<OsimFrames::Place> OsimFrames::Find(const std::string& owner, std::string_view socket,
                                                  int line, const std::string& what) {
  Place place;
  std::string from = owner;
  std::string to(socket);
  for (int depth = 0; depth < kLongestChain; ++depth) {
    const int index = to.empty() ? -1 : Look(from, to);
    if (index < 0) {
      diagnostics_->AddError(
          line, to.empty() ? fmt::format("{} names no frame that it hangs on", what)
                           : fmt::format("{} hangs on \"{:.80}\", which is no body and no offset "
                                         "frame of the model",
                                         what, to));
      return std::nullopt;
    }
    const Frame& frame = frames_[index];
    if (frame.body >= 0) {
      place.body = frame.body;
      return place;
    }
    place.X_BF = frame.X * place.X_BF;
    from = frame.path;
    to = frame.parent;
    line = frame.line;
  }
  diagnostics_->AddError(line, fmt::format("{} hangs on \"{:.80}\", which hangs on itself, or on "
                                           "more than {} frames",
                                           what, socket, kLongestChain));
  return std::nullopt;
}

}  // namespace mmm_converter
