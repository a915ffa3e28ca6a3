// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/angles/gait.h"
#include "common/contacts/contacts.h"
#include "common/contacts/person_mass.h"
#include "common/io/c3d/c3d_relabelling.h"
#include "common/kinetics/joint_forces.h"
#include "common/pipeline/input/person.h"

namespace mmm_converter {

struct ConversionReport;
struct ConversionResult;
struct Emg;
struct Input;
struct StoredEvents;

/// What is known of the ground under a tracked person: found once for a conversion.
struct GroundStudy {
  std::shared_ptr<const RecordedForces> forces;  ///< read as the feet have it: FitPlatesToFeet
  std::vector<std::string> doubts;  ///< what speaks against the plates, for the verdict
  FootMotion feet;
  Contacts contacts;
  Contacts steps;                        ///< the same, with the file's events where they count
  std::vector<std::string> event_notes;  ///< what there is to say of the file's events
  std::optional<MassByPlates> mass;
  // What exports ask for: StudyExports.
  std::optional<JointForces> joint_forces;
  std::optional<Gait> gait;
  std::vector<C3dResult> results;
  std::vector<C3dEvent> events;  ///< of the copies of the recording
};

/// Forces of the recording's file, or of the one that is beside it.
RecordedForces GroundForces(const Input& input, Warnings* warnings);

/// When feet come to the ground by the recording's file, and which of it counts ("file", "found";
/// empty: the default). Null: it does not say.
/// @throws Error where it has to say and does not.
std::shared_ptr<const StoredEvents> EventsOfFile(const Input& input, const std::string& choice);

/// Channels of the recording's file (ReadEmg); null: none is asked for. @throws Error
std::shared_ptr<const Emg> EmgOf(const Input& input, const std::string& labels, Warnings* warnings);

/// @throws Error where the recording has no plates.
void CheckHasPlates(const RecordedForces& forces, const Input& input);

/// Warns of plates without any force that is a number. @throws Error where all are so.
void CheckHasForces(const RecordedForces& forces, const Input& input, Warnings* warnings);

/// Of which file the forces are.
const std::string& ForcesFile(const Input& input);

/// Without the frames before the person was seen.
PoseTrajectory TrackedMotion(const ConversionResult& result);

/// That of the report where it has one. warnings: of what plates were taken for; may be null.
/// @throws Error where the model has no feet (HasFeet).
std::shared_ptr<const GroundStudy> StudyGround(const ConversionReport& report,
                                               Warnings* warnings = nullptr);

/// Where a leg shows what the verdict asks of it; without limbs, where the body is seen. By frame
/// of TrackedMotion.
KnownLegs FindKnownLegs(const ConversionReport& report);

/// What plates bore that is given to no foot: when, and which share of all that they bore it is. In
/// a sentence; empty: all is given.
std::string UnappliedSentence(const GroundStudy& ground);

/// How well the times of steps that no plate tells are known, in a sentence; empty: plates or the
/// file tell all.
std::string DeviationSentence(const Contacts& steps);

/// Those that plates tell, and of a foot off the plates those that its leg shows: what begins or
/// ends while that is hidden has no begin or end.
Contacts SeenContacts(const ConversionReport& report, const GroundStudy& ground);

/// Why the plates' forces can't be those of this person; empty: they can.
std::string DoubtOfScale(const std::optional<MassByPlates>& borne, const PersonValue& stated);

/// The mass that plates bore where none was given, else the model's [kg].
double KnownMass(const ConversionReport& report, const GroundStudy& ground);

/// What the plates say of the person's mass beside the one of the person, in a sentence; empty:
/// nothing.
std::string MassSentence(const ConversionReport& report, const GroundStudy& ground);

/// Of KnownMass. @throws Error where there are no plates, or the model has no mass.
JointForces JointForcesOf(const ConversionReport& report, const GroundStudy& ground,
                          bool with_deviations);

/// Strides, and over them angles, without what was hidden, and where there are plates and a mass
/// what legs bear and exert: of joint "ground" the "vertical force" in body weights; of hips, knees
/// and ankles the "extension moment" and so on that muscles exert [N m/kg], each about the axis of
/// its angle, of knees also about axes of the shank about
/// which they can't turn, and their "power" [W/kg]; of joint "residual" what the root would still
/// need, "force" in body weights and "moment" [N m/kg].
Gait GaitOf(const ConversionReport& report, const GroundStudy& ground);

}  // namespace mmm_converter
