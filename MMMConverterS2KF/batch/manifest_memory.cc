// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/manifest_memory.h"

#include <fmt/format.h>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

/// What a batch takes for a recording, and for each byte that is written of it or of a group around
/// it [bytes], measured, and what all may take.
constexpr double kBytesOfRecording = 4200;
constexpr double kBytesOfText = 5;
constexpr double kMostBytesOfByte = 16;
constexpr double kFreeManifestBytes = 512e6;

struct Needs {
  std::size_t recordings = 0;
  double bytes = 0;
};

/// Of the attributes of an element and of its <Metadata>.
double TextBytes(const XmlElement& element) {
  double bytes = 0;
  for (const auto& [name, value] : element.attributes) {
    bytes += static_cast<double>(name.size() + value.size());
  }
  for (const XmlElement& child : element.children) {
    if (child.name == "Metadata") bytes += TextBytes(child);
  }
  return bytes;
}

/// inherited: bytes of the elements around. A group is one more copy of them, until it ends.
void Add(const XmlElement& element, double inherited, Needs* needs) {
  const double text = inherited + TextBytes(element);
  needs->bytes += kBytesOfText * text;
  if (element.name == "Recording") ++needs->recordings;
  if (element.name == "Recording" || element.name == "Person") needs->bytes += kBytesOfRecording;
  for (const XmlElement& child : element.children) {
    if (child.name != "Metadata") Add(child, text, needs);
  }
}

}  // namespace

std::size_t CountRecordings(const XmlElement& manifest, std::size_t file_bytes,
                            const std::string& file) {
  Needs needs;
  Add(manifest, 0, &needs);
  if (needs.bytes > kFreeManifestBytes + kMostBytesOfByte * static_cast<double>(file_bytes)) {
    throw Error(fmt::format(
        "{}: its {} recordings, with what their groups say of them, would take {:.0f} MB of "
        "memory; make several manifests of it, or say less in its groups",
        file, needs.recordings, 1e-6 * needs.bytes));
  }
  return needs.recordings;
}

}  // namespace mmm_converter
