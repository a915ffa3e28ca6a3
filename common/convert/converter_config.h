// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/convert/marker_set.h"
#include "common/convert/settings.h"
#include "common/io/xml/xml_document.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A `<Joint name=""/>` of a configuration.
struct ConfigJoint {
  std::string name;
  int line = 0;
};

/// A `<ConverterConfig type="...">` file: what every converter shares, and the rest for the plugin.
struct ConverterConfig {
  std::string file;                        ///< for messages
  std::string type;                        ///< converter name, e.g. "S2KFConverter"
  std::string model_processor = "Winter";  ///< `Model@name`: "Winter" or "None" (not scaled)
  std::string subject_file;                ///< `Model/Subject@file`; empty: none
  std::vector<MarkerPair> marker_pairs;    ///< empty: see marker_set
  std::string marker_set = "auto";         ///< `MarkerMapping@set`, see ResolveMarkerPairs
  int marker_set_line = 0;
  std::vector<ConfigJoint> joints;  ///< in output order; empty: see joint_set
  std::string joint_set = "auto";   ///< `Joints@set`, see ResolveJoints
  int joint_set_line = 0;
  std::string output_format = "2.0";  ///< `Output@format`: version of MMM's motion format to write
  std::vector<XmlElement> plugin_elements;  ///< all that common code does not know
};

/// Reads KIT's shape too: of a configuration for another converter of KIT's ("NloptConverter") the
/// marker mapping and joints are taken, the rest is left out with a warning, and type is empty.
/// @throws Error with file and line for anything that is not well-formed or not allowed.
ConverterConfig ReadConverterConfig(const std::string& path, Warnings* warnings = nullptr);

/// As ReadConverterConfig, from text; `file` is only named in messages.
ConverterConfig ParseConverterConfig(const std::string& xml, const std::string& file,
                                     Warnings* warnings = nullptr);

/// The joints to track, as indices of the model, in output order: config.joints, or else those of
/// joint_set, which is "mmm44" or "mmm40" (the joints of KIT's motions since 2016 and before),
/// "all", the name of a node set of the model, or "auto": mmm44 as far as the model has them; all
/// joints if it has none.
/// @throws Error naming file and line for an unknown or repeated joint, and for an unknown set.
std::vector<int> ResolveJoints(const ConverterConfig& config, const KinematicModel& model);

/// Which labels stand for which markers: config.marker_pairs, or else those of marker_set, as far
/// as the model has their markers. marker_set is the name of a shipped set or of its file
/// ("kit53"), a file ("my_set.xml", relative to the configuration), or "auto": of the shipped sets
/// and the names of the model's markers what knows most of the labels. name: the set's,
/// or "" for a list.
/// @throws Error where there is no such set, or no set knows three labels.
std::vector<MarkerPair> ResolveMarkerPairs(const ConverterConfig& config,
                                           const MarkerLabels& labels, const KinematicModel& model,
                                           std::string* name);

/// Of the shipped sets and the names of the model's markers what knows most of the labels; nothing
/// where none knows three.
std::optional<MarkerSet> FindKnownSet(const MarkerLabels& labels, const KinematicModel& model);

/// The marker set that the configuration names as a file; nothing where it names none.
/// @throws Error as ReadMarkerSet.
std::optional<MarkerSet> ReadOwnMarkerSet(const ConverterConfig& config);

/// The documented template of a configuration: the parts that all converters share at their
/// defaults, then those of the plugin's settings with their present values.
std::string FormatConfigTemplate(const std::string& type, const SettingTable& plugin_settings);

}  // namespace mmm_converter
