// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter {

/// The file that the common library was loaded from.
std::string LibraryFile();

/// Its folder; plugins and data are found relative to it,
/// so that an installation can be moved.
std::string LibraryDirectory();

/// The folder of models/, marker_sets/, converters/ and schema/: the environment variable
/// MMM_CONVERTER_DATA, or else share/MMMConverterS2KF of the installation or build tree.
std::string DataDirectory();

/// Full path of a shipped file, e.g. DataFile("models/mmm.xml").
/// @throws Error saying where it was looked for, if it does not exist.
std::string DataFile(const std::string& relative_path);

}  // namespace mmm_converter
