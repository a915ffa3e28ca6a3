// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace mmm_converter {

// Files that are compiled in; CMakeLists.txt says which. ...Sha256() are 32 bytes.

std::string_view PageFrame();  ///< of every page, with places {{name}}
std::string_view PlotLibrary();
std::string_view PlotLibrarySha256();
std::string_view SceneLibrary();
std::string_view SceneLibrarySha256();
std::string_view LibraryLicences();

// Of a report.
std::string_view PageContent();
std::string_view PageStyles();
std::string_view PageScript();
std::string_view PageScriptSha256();

// Of the index of a batch.
std::string_view IndexContent();
std::string_view IndexStyles();
std::string_view IndexScript();
std::string_view IndexScriptSha256();

// Of a motion's dynamics.
std::string_view DynamicsContent();
std::string_view DynamicsStyles();
std::string_view DynamicsScript();
std::string_view DynamicsScriptSha256();

// Of a recording's labels; styles as of a motion's dynamics.
std::string_view LabelContent();
std::string_view LabelScript();
std::string_view LabelScriptSha256();

// Of a motion on a robot.
std::string_view RobotContent();
std::string_view RobotStyles();
std::string_view RobotScript();
std::string_view RobotScriptSha256();

// Of a live view; the rest of its styles is a report's.
std::string_view LiveContent();
std::string_view LiveStyles();
std::string_view LiveScript();
std::string_view LiveScriptSha256();

}  // namespace mmm_converter
