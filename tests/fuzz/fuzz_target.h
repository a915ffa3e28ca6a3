// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace mmm_converter::testing {

/// A reader, given any bytes. What it returns of them is checked by Require.
/// @throws Error where it refuses them; anything else that is thrown is a fault.
using FuzzTarget = void (*)(std::string_view bytes);

/// By name: "c3d", "trc", ...
const std::map<std::string, FuzzTarget>& FuzzTargets();

/// Why the target refuses the bytes, which must name the file, kInputName; empty: it reads them.
std::string Refusal(FuzzTarget target, std::string_view bytes);

/// What messages call the input of readers that are given no file.
inline constexpr const char* kInputName = "input";

/// A file called kInputName with these bytes, until the next call, in a folder of its own.
std::string FileOf(std::string_view bytes);

/// @throws std::logic_error saying what was expected.
void Require(bool holds, const std::string& expected);

void ReadBvhBytes(std::string_view bytes);
void ReadC3dBytes(std::string_view bytes);
void ReadTrcBytes(std::string_view bytes);
void ReadNexusCsvBytes(std::string_view bytes);
void ReadNpzBytes(std::string_view bytes);
void ReadMotiveCsvBytes(std::string_view bytes);
void ReadPointsCsvBytes(std::string_view bytes);
void ReadQtmTsvBytes(std::string_view bytes);
void ReadMmmMotionBytes(std::string_view bytes);
void ReadMmmModelBytes(std::string_view bytes);
void ReadOsimBytes(std::string_view bytes);
void ReadBodyMapBytes(std::string_view bytes);
void ReadScaleSetupBytes(std::string_view bytes);
void ReadIkTasksBytes(std::string_view bytes);
void ReadExternalLoadsBytes(std::string_view bytes);
void ReadMarkerFileBytes(std::string_view bytes);
void ReadOsimSetupBytes(std::string_view bytes);
void ReadMeshBytes(std::string_view bytes);
void ReadMjcfBytes(std::string_view bytes);
void ReadUrdfBytes(std::string_view bytes);
void ReadPersonBytes(std::string_view bytes);
void ReadConverterConfigBytes(std::string_view bytes);
void ReadMarkerSetBytes(std::string_view bytes);
void ReadManifestBytes(std::string_view bytes);
void ReadSubjectsTableBytes(std::string_view bytes);
void ReadJournalBytes(std::string_view bytes);
void ReadLcdSamplesBytes(std::string_view bytes);
void ReadRecordingBytes(std::string_view bytes);
void ReadNatNetBytes(std::string_view bytes);
void ReadQtmBytes(std::string_view bytes);
void ConvertRecordingBytes(std::string_view bytes);

}  // namespace mmm_converter::testing
