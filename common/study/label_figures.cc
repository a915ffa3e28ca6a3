// SPDX-License-Identifier: MIT
#include "common/study/label_figures.h"

#include <cmath>
#include <utility>

#include "common/study/told_distances.h"
#include "common/study/worn_distances.h"
#include "common/support/error.h"

namespace mmm_converter {

std::vector<LabelPlace> MeasurePlaces(const TrackingSetup& setup, const MarkerSequence& markers,
                                      const PoseTrajectory& trajectory) {
  const Eigen::VectorXd told = ToldDistances(setup, markers, trajectory);
  const Eigen::VectorXd worn = WornDistances(setup, markers, trajectory);
  std::vector<LabelPlace> places;
  places.reserve(setup.assignments().size());
  for (const MarkerAssignment& one : setup.assignments()) {
    const auto i = static_cast<Eigen::Index>(places.size());
    places.push_back({markers.labels()[one.label], one.noise_scale, std::fmax(told[i], worn[i])});
  }
  return places;
}

std::optional<ExchangedSides> FindExchangedSides(TrackingSetup setup,
                                                 std::shared_ptr<const KinematicModel> reference,
                                                 PersonScaling person,
                                                 const MarkerSequence& markers) {
  setup.model = std::move(reference);
  person.subject = nullptr;
  ScaleToPerson(person, &setup);
  return FindExchangedSides(setup, markers);
}

std::optional<HeightEstimate> TellHeight(const TrackingSetup& setup,
                                         const KinematicModel& reference,
                                         const MarkerSequence& markers,
                                         const std::vector<Posture>* track) {
  try {
    return EstimateHeight(setup, reference, markers, track);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace mmm_converter
