// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/contacts/contacts.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

/// Forces for OpenSim: a table (.mot) of force, centre of pressure and free moment for each plate
/// and foot that it bears, at the forces' rate from `begin` to `end` [s], and the ExternalLoads XML
/// that applies them to calcn_l and calcn_r. Newtons, metres, y up: x, y, z are x, z, -y of W, as
/// FormatTrc has them. Unloaded: no force, and the centre of pressure stays where it was, as
/// OpenSim runs splines through it. What both feet or nobody bears is written, and not applied.
/// Plates without a centre of pressure are left out. All must outlive the texts.
struct ExternalLoads {
  const RecordedForces* forces = nullptr;
  const Contacts* contacts = nullptr;
  double begin = 0, end = 0;
};

/// @throws Error where a loaded sample has no number.
TextPieces FormatExternalLoadsTable(const ExternalLoads& loads, const std::string& file_name);

/// How such XML begins.
inline constexpr const char* kExternalLoadsBegin =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<OpenSimDocument Version=\"40000\">\n"
    "  <ExternalLoads name=\"forces\">\n    <objects>\n";

/// table: name of the table's file, beside the XML.
std::string FormatExternalLoadsXml(const ExternalLoads& loads, const std::string& table);

}  // namespace mmm_converter
