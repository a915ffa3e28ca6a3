// SPDX-License-Identifier: MIT
// What files are known to hold wrong of a plate, found from where the loaded centre of pressure
// lies.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/forces/plate_forces.h"

namespace mmm_converter {

/// Along the surface's normal, up, of each sample [N].
Eigen::VectorXd VerticalForce(const PlateForces& forces);

/// The vertical force of a plate that bears nobody [N]: the middle of the densest part of the
/// samples near zero. Nothing: the plate is never unloaded.
std::optional<double> UnloadedLevel(const Eigen::VectorXd& vertical);

/// The unit of moments: the stated one, unless the loaded centre of pressure lies off the plate
/// with it and on it with another.
void CorrectUnits(const Eigen::MatrixXd& channels, ForcePlate* plate, Warnings* warnings);

/// ORIGIN whose z is 0 stays, unless the loaded centre of pressure lies off the plate with it and
/// on it with the reversed one.
void CorrectOrigin(const Eigen::MatrixXd& channels, ForcePlate* plate, Warnings* warnings);

/// Fills unloaded_level to loads; reverses forces that point down while somebody stands there.
/// rate: of samples [Hz].
void JudgeLoads(double rate, PlateForces* forces, Warnings* warnings);

/// Takes away from each channel what it shows while nobody is on the plate, between these times on
/// straight lines, where that is more than 25 N. rate: of samples [Hz].
void SubtractUnloaded(double rate, const ForcePlate& plate, Eigen::MatrixXd* channels,
                      Warnings* warnings);

/// Fills clipped: a loaded channel that stands still at its extreme between steep slopes, or long
/// beside one, is at the end of its range. first_time: of sample 0 [s].
void FindClipped(double rate, double first_time, PlateForces* forces, Warnings* warnings);

/// No numbers from where all channels of the plate stand still to the end, at a load that nobody is
/// there to exert: the recorder had stopped. first_time: of sample 0 [s].
void LeaveOutStopped(double rate, double first_time, const ForcePlate& plate,
                     Eigen::MatrixXd* channels, Warnings* warnings);

/// Fx and Fy whose channel never changes, as rows of these: they are not measured.
std::vector<int> StillShears(const ForcePlate& plate, const Eigen::MatrixXd& channels);

/// No moments where one of these is not measured and somebody is on the plate.
void LeaveOutStill(const std::vector<int>& shears, PlateForces* forces, Warnings* warnings);

/// No centre of pressure where a moment's channel stands still while the plate is loaded.
void LeaveOutSaturated(const Eigen::MatrixXd& channels, PlateForces* forces, Warnings* warnings);

}  // namespace mmm_converter
