// SPDX-License-Identifier: MIT
#include "common/convert/checked_converter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <utility>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr double kQuaternionTolerance = 1e-6;  // of a quaternion's length

[[noreturn]] void ThrowFaulty(const std::string& file, const std::string& why) {
  throw Error(fmt::format("{}: the plugin is faulty: {}; nothing of it is used", file, why));
}

/// What the action gives, or what went wrong in the plugin as an Error.
template <typename Action>
decltype(auto) Guarded(const std::string& file, const Action& action) {
  try {
    return action();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    ThrowFaulty(file, failure.what());
  } catch (...) {
    ThrowFaulty(file, "it threw something that is no exception");
  }
}

template <typename... Args>
void Require(bool holds, fmt::format_string<Args...> complaint, Args&&... args) {
  if (!holds) throw std::logic_error(fmt::format(complaint, std::forward<Args>(args)...));
}

void RequireSize(const char* what, Eigen::Index size, Eigen::Index expected) {
  Require(size == expected, "it gave {} {}, not {}", size, what, expected);
}

void CheckPosture(const Posture& posture, Eigen::Index num_joints) {
  RequireSize("joint angles", posture.joint_angles.size(), num_joints);
  Require(posture.position.allFinite() && posture.joint_angles.allFinite() &&
              std::abs(posture.orientation.coeffs().norm() - 1) <= kQuaternionTolerance,
          "it gave a posture that is not finite, or whose orientation is not a unit quaternion");
}

/// NaN: not seen.
void CheckResiduals(const Eigen::Ref<const Eigen::MatrixXd>& residuals) {
  Require(
      (residuals.array().isNaN() || (residuals.array() >= 0 && residuals.array().isFinite())).all(),
      "it gave a distance of a marker that is infinite or negative");
}

void CheckSetup(const TrackingSetup& setup, const TrackingSetup& given) {
  const auto is_same = [](const MarkerAssignment& a, const MarkerAssignment& b) {
    return a.label == b.label && a.marker == b.marker;
  };
  const auto& assignments = setup.assignments();
  const auto& given_assignments = given.assignments();
  Require(setup.model != nullptr && setup.model->num_joints() == given.model->num_joints() &&
              setup.model->markers().size() == given.model->markers().size(),
          "its converter tracks another model than the one given to it");
  Require(setup.joints == given.joints, "its converter tracks other joints than those given to it");
  Require(std::equal(assignments.begin(), assignments.end(), given_assignments.begin(),
                     given_assignments.end(), is_same),
          "its converter uses other markers than those given to it");
}

void CheckIncidents(const std::vector<MarkerIncident>& incidents, int assignments, int frames) {
  for (const MarkerIncident& incident : incidents) {
    const bool is_swapped = incident.kind == MarkerIncident::Kind::kSwapped;
    const bool is_known = is_swapped || incident.kind == MarkerIncident::Kind::kMisplaced;
    Require(is_known && incident.assignment >= 0 && incident.assignment < assignments &&
                incident.other >= (is_swapped ? 0 : -1) && incident.other < assignments &&
                incident.first_frame >= 0 && incident.first_frame <= incident.last_frame &&
                incident.last_frame < frames,
            "it gave an incident of a marker, a frame or a kind that there is not");
  }
}

void CheckTrajectory(const PoseTrajectory& trajectory, const TrackingSetup& setup,
                     const MarkerSequence& recording) {
  std::vector<std::string> joint_names;
  for (const int joint : setup.joints) joint_names.push_back(setup.model->joint(joint).name);
  Require(trajectory.joint_names == joint_names, "it gave other joints than those to track");
  const auto num_joints = static_cast<Eigen::Index>(joint_names.size());
  const Eigen::Index frames = recording.num_frames();
  RequireSize("postures", static_cast<Eigen::Index>(trajectory.postures.size()), frames);
  for (const Posture& posture : trajectory.postures) CheckPosture(posture, num_joints);
  Require(trajectory.rate == recording.rate() && trajectory.first_time == recording.first_time(),
          "it gave other times than those of the recording");
  for (const Eigen::MatrixXd* numbers :
       {&trajectory.standard_deviations, &trajectory.velocities, &trajectory.accelerations}) {
    if (numbers->size() == 0) continue;
    RequireSize("rows of deviations or derivatives", numbers->rows(), 6 + num_joints);
    RequireSize("columns of deviations or derivatives", numbers->cols(), frames);
  }
}

void CheckCovariances(const std::vector<PoseCovariance>& covariances, Eigen::Index size,
                      int frames) {
  int next = 0;
  for (const PoseCovariance& one : covariances) {
    Require(one.frame >= next && one.frame < frames,
            "it gave covariances of frames that there are not, or in another order");
    next = one.frame + 1;
    RequireSize("rows of a covariance", one.covariance.rows(), size);
    RequireSize("columns of a covariance", one.covariance.cols(), size);
    Require(one.covariance.allFinite(), "it gave a covariance that is not finite");
  }
}

void CheckResult(const ConversionResult& result, const TrackingSetup& setup,
                 const MarkerSequence& recording) {
  CheckTrajectory(result.trajectory, setup, recording);
  const int assignments = static_cast<int>(setup.assignments().size());
  RequireSize("rows of residuals", result.residuals.rows(), assignments);
  RequireSize("columns of residuals", result.residuals.cols(), recording.num_frames());
  CheckResiduals(result.residuals);
  RequireSize("frames", static_cast<Eigen::Index>(result.frames.size()), recording.num_frames());
  CheckIncidents(result.incidents, assignments, recording.num_frames());
  CheckCovariances(result.covariances, 6 + static_cast<Eigen::Index>(setup.joints.size()),
                   recording.num_frames());
  const double scale = result.process_noise_scale.value_or(1);
  Require(scale > 0 && std::isfinite(scale), "it gave a factor of {} on its noise", scale);
}

class CheckedConverter final : public MotionConverter {
 public:
  CheckedConverter(const TrackingSetup& setup, std::unique_ptr<MotionConverter> converter,
                   std::string file)
      : MotionConverter(setup), converter_(std::move(converter)), file_(std::move(file)) {}

  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) override {
    return Checked([&]() -> const FrameEstimate& { return converter_->Assemble(frame); });
  }

  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, double dt) override {
    return Checked([&]() -> const FrameEstimate& { return converter_->Track(frame, dt); });
  }

  void Prepare(double dt) override {
    Guarded(file_, [&] { converter_->Prepare(dt); });
  }

  ConversionResult Convert(const MarkerSequence& recording,
                           const std::function<bool(int)>& progress) override {
    return Guarded(file_, [&] {
      ConversionResult result = converter_->Convert(recording, progress);
      CheckResult(result, setup(), recording);
      return result;
    });
  }

  bool KeepCovariances() override {
    return Guarded(file_, [&] { return converter_->KeepCovariances(); });
  }

 private:
  template <typename Step>
  const FrameEstimate& Checked(const Step& step) const {
    return Guarded(file_, [&]() -> const FrameEstimate& {
      const FrameEstimate& estimate = step();
      CheckEstimate(estimate, setup());
      return estimate;
    });
  }

  std::unique_ptr<MotionConverter> converter_;
  std::string file_;
};

class CheckedFactory final : public MotionConverterFactory {
 public:
  CheckedFactory(std::unique_ptr<MotionConverterFactory> factory, std::string file)
      : factory_(std::move(factory)), file_(std::move(file)) {}

  std::string name() const override {
    return Guarded(file_, [&] {
      std::string name = factory_->name();
      Require(!name.empty(), "its converter has no name");
      return name;
    });
  }
  std::string description() const override {
    return Guarded(file_, [&] { return factory_->description(); });
  }
  std::string config_template() const override {
    return Guarded(file_, [&] { return factory_->config_template(); });
  }
  std::unique_ptr<MotionConverter> Create(const TrackingSetup& setup,
                                          const ConverterConfig& config) const override {
    return Guarded(file_, [&]() -> std::unique_ptr<MotionConverter> {
      std::unique_ptr<MotionConverter> converter = factory_->Create(setup, config);
      Require(converter != nullptr, "it gave no converter");
      CheckSetup(converter->setup(), setup);
      return std::make_unique<CheckedConverter>(setup, std::move(converter), file_);
    });
  }

 private:
  std::unique_ptr<MotionConverterFactory> factory_;
  std::string file_;
};

}  // namespace

void CheckEstimate(const FrameEstimate& estimate, const TrackingSetup& setup) {
  const auto assignments = static_cast<Eigen::Index>(setup.assignments().size());
  const int num_joints = setup.model->num_joints();
  CheckPosture(estimate.posture, num_joints);
  if (estimate.standard_deviations.size() > 0) {
    RequireSize("standard deviations", estimate.standard_deviations.size(), 6 + num_joints);
  }
  RequireSize("residuals", estimate.residuals.size(), assignments);
  CheckResiduals(estimate.residuals);
  if (estimate.verdicts.size() > 0) {
    RequireSize("verdicts", estimate.verdicts.size(), assignments);
    Require(
        estimate.verdicts.minCoeff() >= kAsLabelled && estimate.verdicts.maxCoeff() < assignments,
        "it gave a verdict that names no marker");
  }
  for (const int count :
       {estimate.markers_seen, estimate.markers_downweighted, estimate.markers_wrong}) {
    Require(count >= 0 && count <= assignments, "it counted {} of {} markers", count, assignments);
  }
}

std::unique_ptr<MotionConverterFactory> WithChecks(std::unique_ptr<MotionConverterFactory> factory,
                                                   std::string file) {
  return std::make_unique<CheckedFactory>(std::move(factory), std::move(file));
}

}  // namespace mmm_converter
