// SPDX-License-Identifier: MIT
//
// Persons of models of OpenSim, motions and markers that are made.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>

#include "common/convert/motion_converter.h"
#include "common/model/kinematic_model.h"
#include "common/model/subject.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

inline constexpr int kFrames = 300;
inline constexpr double kRate = 100;  ///< [Hz]

using ModelPtr = std::shared_ptr<const KinematicModel>;

struct Case {
  ModelPtr generic;  ///< lengths of the model
  ModelPtr person;   ///< lengths of the person, markers where the model has them
  ModelPtr known;    ///< the person with the markers where they are worn
  std::map<std::string, Eigen::Vector3d> factors;  ///< of the person's bodies
  PoseTrajectory truth;
  MarkerSequence markers;
  MarkerSequence standing;  ///< of the person at rest, for 1 s
};

/// The file, with three markers on each body where it has none.
std::string ReadModelText(const std::string& file);

/// "knee_angle_r" and "knee_angle_l" are one group.
std::string GroupOf(std::string name);

Case MakeCase(const std::string& text, int seed);
/// The same person, who moves otherwise.
Case MoveOtherwise(const Case& made, int seed, int motion_seed);

/// The model with what follows others, or moves by a function, held at rest.
KinematicModel HoldFollowers(const KinematicModel& model);

/// Labels in the order of the model's markers; joints that the motion names and the model has not
/// are left out.
MarkerSequence RecordMotion(const KinematicModel& model, const PoseTrajectory& motion, int seed);

ConversionResult Track(const ModelPtr& model, const std::string& preset,
                       const MarkerSequence& seen);

struct CalibratedPerson {
  ModelPtr model;  ///< with the markers' deviations
  Subject subject;
  double size = 1;  ///< which the subject's scales are of
  std::map<std::string, Eigen::Vector3d> factors;
  int iterations = 0;
};

/// By the motion and the standing person.
CalibratedPerson Calibrate(const std::string& text, const Case& made);

}  // namespace mmm_converter
