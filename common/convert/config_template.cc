// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "common/convert/converter_config.h"

namespace mmm_converter {
namespace {

constexpr const char* kShared = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- A configuration of the {0}. Every value is the default, so any line may be left out;
     an attribute's name ends with its unit. -->
<ConverterConfig type="{0}">
  <!-- name: Winter (the reference model is scaled by the person's height and mass) or
       None (it is used as it is, like every URDF) -->
  <Model name="Winter">
    <!-- Who the person is: a file that calibrate wrote, relative to this one; the option
         subject-file of the command line comes first:
         <Subject file="1723.xml"/> -->
    <!-- Which label of the recording stands for which marker of the model.
         set: the name of a shipped marker set, a file of that kind, or auto (of the shipped sets and
         the names of the model's own markers what knows most labels). Or a list; noiseScale: factor
         on the marker's standard deviation, above 1 trusts it less. Of several labels for one marker
         the first that is seen is taken:
         <MarkerMapping>
           <Mapping source="C7" target="MARKER_C7" noiseScale="1"/>
           ...
         </MarkerMapping> -->
    <MarkerMapping set="auto"/>
    <!-- Which joints are tracked; all others stay at 0.
         set: mmm44 (the joints of KIT's motions), mmm40 (without the feet's LFx, LMrot, RFx and
         RMrot), all, the name of a node set of the model, or auto (mmm44 as far as the model has
         them). Or a list, in the order of the output:
         <Joints>
           <Joint name="BLNx_joint"/>
           ...
         </Joints> -->
    <Joints set="auto"/>
  </Model>

)";

constexpr const char* kOutput =
    R"(  <!-- The motion that is written. format: version of MMM's motion format (2.0 or 1.0); the command
       line's option of that name comes first -->
  <Output format="2.0"/>
)";

}  // namespace

std::string FormatConfigTemplate(const std::string& type, const SettingTable& plugin_settings) {
  return fmt::format(kShared, type) + plugin_settings.ToXml(2) + kOutput + "</ConverterConfig>\n";
}

}  // namespace mmm_converter
