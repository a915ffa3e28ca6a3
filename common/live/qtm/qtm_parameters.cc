// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_parameters.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr const char* kXmlName = "QTM's parameters";
constexpr int kFirstMinorOfSoftwareTrigger = 15;
constexpr int kFirstMinorOfRealTimeActions = 14;
constexpr int kFirstMinorOfGaze = 12;
constexpr int kFirstMinorOfEulerInGeneral = 21;
constexpr int kFirstMinorOfCalibrationTime = 10;

[[noreturn]] void Fail(const XmlElement& element, const std::string& what) {
  throw Error(fmt::format("{}:{}: {}", kXmlName, element.line, what));
}

double NumberOf(const XmlElement& parent, const char* name) {
  const XmlElement* child = parent.FindChild(name);
  if (child == nullptr) return 0;
  const auto number = ParseDouble(child->text);
  if (!number || !std::isfinite(*number) || *number < 0) {
    Fail(*child, fmt::format("<{}> is \"{}\"; it must be a number", name, child->text));
  }
  return *number;
}

void Read3d(const XmlElement& element, QtmParameters* parameters) {
  parameters->has_3d = true;
  if (const XmlElement* axis = element.FindChild("AxisUpwards")) {
    const auto up_axis = StatedUpAxis(axis->text);
    if (!up_axis) {
      Fail(*axis,
           fmt::format("<AxisUpwards> is \"{}\"; it must be +X, +Y, +Z, -X, -Y or -Z", axis->text));
    }
    parameters->up_axis = *up_axis;
  }
  if (const XmlElement* time = element.FindChild("CalibrationTime")) {
    parameters->calibration_time = time->text;
  }
  for (const XmlElement* label : element.FindChildren("Label")) {
    const XmlElement* name = label->FindChild("Name");
    std::string text(Trim(ToUtf8(name == nullptr ? "" : name->text)));
    if (text.empty()) Fail(*label, "a <Label> without a <Name>");
    parameters->labels.push_back(std::move(text));
  }
  if (const XmlElement* count = element.FindChild("Labels")) {
    const auto number = ParseLong(count->text);
    if (!number || *number != static_cast<long>(parameters->labels.size())) {
      Fail(*count, fmt::format("<Labels> says \"{}\", and {} follow", count->text,
                               parameters->labels.size()));
    }
  }
}

void AppendGeneral(const QtmParameters& parameters, int minor, std::string* out) {
  *out += "  <General>\n    <Frequency>";
  AppendDecimal(parameters.rate, 6, out);
  *out += fmt::format("</Frequency>\n    <Capture_Time>{:.6f}</Capture_Time>\n",
                      parameters.capture_time);
  *out += "    <Start_On_External_Trigger>false</Start_On_External_Trigger>\n";
  if (minor >= kFirstMinorOfSoftwareTrigger) {
    *out +=
        "    <Start_On_Trigger_NO>false</Start_On_Trigger_NO>\n"
        "    <Start_On_Trigger_NC>false</Start_On_Trigger_NC>\n"
        "    <Start_On_Trigger_Software>false</Start_On_Trigger_Software>\n";
  }
  *out +=
      "    <External_Time_Base>\n"
      "      <Enabled>false</Enabled>\n"
      "      <Signal_Source>Control port</Signal_Source>\n"
      "      <Signal_Mode>Periodic</Signal_Mode>\n"
      "      <Frequency_Multiplier>1</Frequency_Multiplier>\n"
      "      <Frequency_Divisor>1</Frequency_Divisor>\n"
      "      <Frequency_Tolerance>1000</Frequency_Tolerance>\n"
      "      <Nominal_Frequency>None</Nominal_Frequency>\n"
      "      <Signal_Edge>Negative</Signal_Edge>\n"
      "      <Signal_Shutter_Delay>0</Signal_Shutter_Delay>\n"
      "      <Non_Periodic_Timeout>10.000000</Non_Periodic_Timeout>\n"
      "    </External_Time_Base>\n";
  constexpr std::array kActions = {"Processing_Actions", "RealTime_Processing_Actions",
                                   "Reprocessing_Actions"};
  for (std::size_t i = 0; i < (minor >= kFirstMinorOfRealTimeActions ? 3U : 1U); ++i) {
    const bool of_files = i != 1;
    *out += fmt::format("    <{}>\n", kActions[i]);
    const auto append = [&](const char* name, const char* value) {
      *out += fmt::format("      <{0}>{1}</{0}>\n", name, value);
    };
    if (minor >= kFirstMinorOfRealTimeActions) append("PreProcessing2D", "true");
    append("Tracking", "3D");
    if (of_files) append("TwinSystemMerge", "false");
    if (of_files) append("SplineFill", "false");
    append("AIM", "true");
    append("Track6DOF", "false");
    append("ForceData", "false");
    if (minor >= kFirstMinorOfGaze) append("GazeVector", "false");
    if (of_files) {
      for (const char* name : {"ExportTSV", "ExportC3D", "ExportMatlabFile"}) append(name, "false");
      if (minor >= kFirstMinorOfGaze) append("ExportAviFile", "false");
    }
    *out += fmt::format("    </{}>\n", kActions[i]);
  }
  if (minor >= kFirstMinorOfEulerInGeneral) {
    *out += "    <EulerAngles First=\"Roll\" Second=\"Pitch\" Third=\"Yaw\"/>\n";
  }
  *out += "  </General>\n";
}

void Append3d(const QtmParameters& parameters, int minor, std::string* out) {
  *out += fmt::format("  <The_3D>\n    <AxisUpwards>{}</AxisUpwards>\n",
                      fmt::format("{0}{1}", Name(parameters.up_axis)[0],
                                  "XYZ"[static_cast<int>(parameters.up_axis) % 3]));
  if (minor >= kFirstMinorOfCalibrationTime) {
    *out += fmt::format("    <CalibrationTime>{}</CalibrationTime>\n",
                        EscapeXml(parameters.calibration_time.value_or("")));
  }
  *out += fmt::format("    <Labels>{}</Labels>\n", parameters.labels.size());
  for (const std::string& label : parameters.labels) {
    *out += fmt::format(
        "    <Label>\n      <Name>{}</Name>\n      <RGBColor>65280</RGBColor>\n    </Label>\n",
        EscapeXml(label));
  }
  *out += "    <Bones>\n    </Bones>\n  </The_3D>\n";
}

void Append6d(int minor, std::string* out) {
  *out += "  <The_6D>\n";
  if (minor < kFirstMinorOfEulerInGeneral) {
    *out +=
        "    <Bodies>0</Bodies>\n    <Euler>\n      <First>Roll</First>\n"
        "      <Second>Pitch</Second>\n      <Third>Yaw</Third>\n    </Euler>\n";
  }
  *out += "  </The_6D>\n";
}

}  // namespace

QtmParameters ParseQtmParameters(std::string_view xml) {
  const XmlElement root = ParseXml(xml, kXmlName);
  if (!ToLower(root.name).starts_with("qtm_parameters_ver_")) {
    Fail(root, fmt::format("the root is <{}>; it must be <QTM_Parameters_Ver_...>", root.name));
  }
  QtmParameters parameters;
  if (const XmlElement* general = root.FindChild("General")) {
    parameters.rate = NumberOf(*general, "Frequency");
    parameters.capture_time = NumberOf(*general, "Capture_Time");
  }
  if (const XmlElement* the_3d = root.FindChild("The_3D")) Read3d(*the_3d, &parameters);
  return parameters;
}

std::string FormatQtmParameters(const QtmParameters& parameters, const QtmParameterChoice& choice,
                                int minor) {
  std::string xml = fmt::format("<QTM_Parameters_Ver_1.{}>\n", minor);
  if (choice.general) AppendGeneral(parameters, minor, &xml);
  if (choice.the_3d) Append3d(parameters, minor, &xml);
  if (choice.the_6d) Append6d(minor, &xml);
  if (choice.analog) xml += "  <Analog>\n  </Analog>\n";
  if (choice.force) {
    xml +=
        "  <Force>\n    <Unit_Length>mm</Unit_Length>\n    <Unit_Force>N</Unit_Force>\n"
        "  </Force>\n";
  }
  if (choice.gaze_vector) xml += "  <Gaze_Vector>\n  </Gaze_Vector>\n";
  if (choice.eye_tracker) xml += "  <Eye_Tracker>\n  </Eye_Tracker>\n";
  if (choice.image) xml += "  <Image>\n  </Image>\n";
  if (choice.skeleton) xml += "  <Skeletons>\n  </Skeletons>\n";
  return xml + fmt::format("</QTM_Parameters_Ver_1.{}>\n", minor);
}

}  // namespace mmm_converter
