// SPDX-License-Identifier: MIT
// Postures while frames come.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "MMMConverterS2KF/python/arrays.h"
#include "MMMConverterS2KF/python/estimates.h"
#include "MMMConverterS2KF/python/module.h"
#include "MMMConverterS2KF/python/requests.h"
#include "common/convert/tracked_joints.h"
#include "common/pipeline/live/live_stream.h"
#include "common/support/error.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook(50);  // for Ctrl-C
constexpr std::size_t kMostWaiting = 64;        // postures

// Who the postures are of.
struct TrackedBody {
  std::shared_ptr<const LiveBody> body;
  std::shared_ptr<const PersonModel> model;
};

struct TrackedPosture {
  std::shared_ptr<const TrackedBody> body;
  PoseFrame frame;
};

/// A stream that is tracked from the first Next on. Where the caller is slower than the stream,
/// those that wait give way to the newest; a replay @max waits for the caller.
class Live {
 public:
  Live(LiveRequest request, const py::object& tell)
      : request_(std::move(request)), tell_(tell), stream_(MakeStream()) {}
  ~Live() {
    try {
      const py::gil_scoped_release release;
      End();
      stream_.reset();
    } catch (const std::exception&) {  // nobody is there to hear of it
    }
  }
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;

  // None: the stream has ended.
  py::object Next() {
    if (is_closed_) return py::none();
    if (!std::exchange(has_begun_, true)) {
      begun_ = steady_clock::now();
      stream_->Start();
    }
    std::optional<TrackedPosture> next;
    try {
      while (!next) {
        if (IsOver()) stream_->Stop();
        const bool has_ended = stream_->has_ended();
        next = Wait(has_ended);
        TellNews();
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (!next && has_ended) break;
      }
    } catch (...) {
      Close();
      throw;
    }
    if (next) return DictOf(*next);
    Close();
    if (stream_->failure()) std::rethrow_exception(stream_->failure());
    return py::none();
  }

  void Close() {
    if (std::exchange(is_closed_, true)) return;
    const py::gil_scoped_release release;
    End();
  }

  LiveStatus status() const {
    LiveStatus status = stream_->status();
    status.dropped += given_way_;
    return status;
  }

 private:
  std::unique_ptr<LiveStream> MakeStream() {
    Warnings warnings;
    std::unique_ptr<LiveStream> stream;
    {
      const py::gil_scoped_release release;
      stream = std::make_unique<LiveStream>(
          request_, OpenSourceOf(request_, &warnings),
          [this](const auto& body, const PoseFrame& frame) { Give(body, frame); },
          [this](bool is_warning, std::string text) {
            const std::lock_guard lock(mutex_);
            news_.emplace_back(is_warning, std::move(text));
          });
    }
    for (const std::string& text : warnings.texts()) tell_(true, text);
    return stream;
  }

  bool IsOver() const {
    const std::chrono::duration<double> seconds = steady_clock::now() - begun_;
    return request_.longest > 0 && seconds.count() > request_.longest;
  }

  void End() {
    stream_->Stop();
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
    }
    taken_.notify_all();
    stream_->Join();
  }

  // On the tracking thread.
  void Give(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame) {
    bodies_.resize(static_cast<std::size_t>(body->count));
    auto& known = bodies_[static_cast<std::size_t>(body->index)];
    if (!known || known->body != body) known = BodyOf(body);
    if (!frame.is_tracking) return;
    TrackedPosture posture = {known, frame};
    std::unique_lock lock(mutex_);
    if (stream_->waits_for_reader()) {
      taken_.wait(lock, [this] { return is_ending_ || waiting_.size() < kMostWaiting; });
    } else if (waiting_.size() == kMostWaiting) {
      given_way_ += static_cast<std::int64_t>(kMostWaiting);
      waiting_.clear();
    }
    waiting_.push_back(std::move(posture));
    lock.unlock();
    given_.notify_one();
  }

  std::shared_ptr<const TrackedBody> BodyOf(const std::shared_ptr<const LiveBody>& body) const {
    const ConversionPlan& plan = stream_->session(body->index).plan();
    auto model = std::make_shared<PersonModel>();
    model->file = plan.input.model_file;
    model->loaded = plan.input.model;
    model->scaling = ScalingOf(plan.person, plan.converter.config);
    model->model = body->setup.model;
    if (body->index == 0 && !request_.robot.file.empty()) {
      model->file = request_.robot.file;
      model->loaded = std::make_shared<LoadedModel>(LoadedModel{*body->setup.model, false, {}});
      model->scaling = {};
    }
    return std::make_shared<const TrackedBody>(TrackedBody{body, std::move(model)});
  }

  std::optional<TrackedPosture> Wait(bool has_ended) {
    const py::gil_scoped_release release;
    std::unique_lock lock(mutex_);
    if (!has_ended) given_.wait_for(lock, kLook, [this] { return !waiting_.empty(); });
    if (waiting_.empty()) return std::nullopt;
    TrackedPosture next = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    taken_.notify_one();
    return next;
  }

  void TellNews() {
    std::vector<std::pair<bool, std::string>> news;
    {
      const std::lock_guard lock(mutex_);
      news.swap(news_);
    }
    for (const auto& [is_warning, text] : news) tell_(is_warning, text);
  }

  static py::object DictOf(const TrackedPosture& posture) {
    const LiveBody& body = *posture.body->body;
    const PoseFrame& frame = posture.frame;
    py::dict result = EstimateDict(body.setup, frame.estimate);
    result["joint_names"] = TrackedJoints(body.setup);
    result["frame"] = frame.number;
    result["time"] = frame.time;
    result["stage"] = frame.stage;
    const py::ssize_t labels = frame.points.cols();
    result["markers"] = py::array_t<double>({labels, py::ssize_t{3}}, frame.points.data());
    result["delay"] = std::chrono::duration<double>(frame.tracked - frame.received).count();
    result["body"] = py::cast(posture.body);
    return result;
  }

  LiveRequest request_;
  py::object tell_;
  std::mutex mutex_;
  std::condition_variable given_, taken_;
  std::deque<TrackedPosture> waiting_;
  std::vector<std::pair<bool, std::string>> news_;
  std::vector<std::shared_ptr<const TrackedBody>> bodies_;  // the tracking thread's
  std::atomic<std::int64_t> given_way_ = 0;
  bool is_ending_ = false;
  bool has_begun_ = false, is_closed_ = false;
  steady_clock::time_point begun_;
  std::unique_ptr<LiveStream> stream_;  // the last: its threads use the others
};

LiveRequest LiveRequestOf(const py::dict& options, bool loops, double calibrate_seconds,
                          double seconds, std::optional<double> sole_height) {
  LiveRequest request;
  static_cast<ConversionRequest&>(request) = RequestOf(options);
  if (const std::string wrong = Contradiction(request); !wrong.empty()) throw Error(wrong);
  request.robot.file = TextOf(options, "robot");
  request.robot.map_file = TextOf(options, "map");
  request.robot.sole_height = sole_height;
  request.robot.hold = TextOf(options, "hold");
  request.robot.weights = TextOf(options, "weights");
  request.robot.sole = TextOf(options, "sole");
  request.loops = loops;
  request.longest = seconds;
  if (request.self_calibrate) {
    request.calibration_time = calibrate_seconds > 0 ? calibrate_seconds : kDefaultCalibration;
    if (!IsCalibrationTime(request.calibration_time)) {
      throw Error(fmt::format("calibrate_seconds: is {}", DescribeCalibrationTime()));
    }
  }
  return request;
}

}  // namespace

void BindLive(py::module_* module) {
  py::class_<TrackedBody, std::shared_ptr<TrackedBody>>(*module, "LiveBody")
      .def_property_readonly("name", [](const TrackedBody& b) { return b.body->name; })
      .def_property_readonly("labels", [](const TrackedBody& b) { return b.body->labels; })
      .def_property_readonly(
          "marker_labels",
          [](const TrackedBody& b) { return UsedLabels(b.body->setup, b.body->labels); })
      .def_property_readonly("rate", [](const TrackedBody& b) { return b.body->rate; })
      .def_property_readonly("is_calibrated",
                             [](const TrackedBody& b) { return b.body->is_calibrated; })
      .def_property_readonly("model", [](const TrackedBody& b) { return *b.model; });
  py::class_<Live>(*module, "Live")
      .def(py::init([](const py::dict& options, bool loops, double calibrate_seconds,
                       double seconds, std::optional<double> sole_height, const py::object& tell) {
        return std::make_unique<Live>(
            LiveRequestOf(options, loops, calibrate_seconds, seconds, sole_height), tell);
      }))
      .def("next", &Live::Next)
      .def("close", &Live::Close)
      .def_property_readonly("stage", [](const Live& l) { return l.status().text; })
      .def_property_readonly("frames", [](const Live& l) { return l.status().frames; })
      .def_property_readonly("dropped", [](const Live& l) { return l.status().dropped; });
}

}  // namespace mmm_converter::python
