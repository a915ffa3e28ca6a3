// SPDX-License-Identifier: MIT
// Bytes a second of reading and writing. RESULTS.md has the figures.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <numeric>
#include <string>

#include "common/io/c3d/c3d_reader.h"
#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/io/tables/trajectory_csv.h"
#include "common/support/atomic_file.h"
#include "tests/support/long_recording.h"

namespace mmm_converter {
namespace {

constexpr int kFrames = 6000;  // one minute

/// The sample recording and its motion, a minute long, and a folder for files.
class Minute {
 public:
  Minute() {
    const std::string examples = std::string(MMM_CONVERTER_SOURCE_DIR) + "/examples/";
    markers = Lengthen(ReadRecording(examples + "handstand.c3d", {}).markers, kFrames);
    trajectory = ReadMmmMotionFile(examples + "handstand_true.xml").motions.front().trajectory;
    std::vector<Posture> postures;
    postures.reserve(kFrames);
    for (int k = 0; k < kFrames; ++k) {
      postures.push_back(trajectory.postures[FrameBackAndForth(k, trajectory.num_frames())]);
    }
    trajectory.postures = std::move(postures);
    const int rows = 6 + static_cast<int>(trajectory.joint_names.size());
    trajectory.standard_deviations = Eigen::MatrixXd::Constant(rows, kFrames, 0.00987654321);
    std::filesystem::create_directory(folder);
    WriteC3d(c3d, markers);
  }
  ~Minute() { std::filesystem::remove_all(folder); }

  MmmMotionOutput output() const {
    MmmMotionOutput output;
    output.motion_name = "subject";
    output.height = 1.8;
    output.mass = 75;
    output.trajectory = &trajectory;
    output.markers = &markers;
    return output;
  }

  MarkerSequence markers;
  PoseTrajectory trajectory;
  std::string folder =
      std::filesystem::temp_directory_path() / ("file_benchmark." + std::to_string(getpid()));
  std::string c3d = folder + "/minute.c3d";
};

const Minute& TheMinute() {
  static const Minute minute;
  return minute;
}

void CountBytes(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

std::size_t CountPieces(const TextPieces& text) {
  std::size_t bytes = 0;
  text([&](std::string_view piece) { bytes += piece.size(); });
  return bytes;
}

void ReadC3d(benchmark::State& state) {
  const Minute& minute = TheMinute();
  std::vector<int> points(minute.markers.num_labels());
  std::iota(points.begin(), points.end(), 0);
  for (auto _ : state) {
    C3dReader reader(minute.c3d);
    benchmark::DoNotOptimize(reader.ReadPoints(points, minute.markers.labels(), 100));
  }
  CountBytes(state, std::filesystem::file_size(minute.c3d));
}

void ReadC3dRecording(benchmark::State& state) {
  const Minute& minute = TheMinute();
  for (auto _ : state) benchmark::DoNotOptimize(ReadRecording(minute.c3d, {}));
  CountBytes(state, std::filesystem::file_size(minute.c3d));
}

void WriteC3dRecording(benchmark::State& state) {
  const Minute& minute = TheMinute();
  for (auto _ : state) WriteC3d(minute.folder + "/written.c3d", minute.markers);
  CountBytes(state, std::filesystem::file_size(minute.c3d));
}

using FormatFunction = TextPieces(const MmmMotionOutput&);
TextPieces FormatAlone(const MmmMotionOutput& output) { return FormatMmmMotion2(output); }

void FormatMotion(benchmark::State& state, FormatFunction* format) {
  const MmmMotionOutput output = TheMinute().output();
  std::size_t bytes = 0;
  for (auto _ : state) bytes = CountPieces(format(output));
  CountBytes(state, bytes);
}

void WriteMotion(benchmark::State& state, FormatFunction* format) {
  const std::string file = TheMinute().folder + "/motion.xml";
  const MmmMotionOutput output = TheMinute().output();
  for (auto _ : state) WriteFileAtomically(file, format(output));
  CountBytes(state, std::filesystem::file_size(file));
}

void FormatCsv(benchmark::State& state) {
  const Minute& minute = TheMinute();
  std::size_t bytes = 0;
  for (auto _ : state) bytes = CountPieces(FormatTrajectoryCsv(minute.trajectory));
  CountBytes(state, bytes);
}

void ReadMotion(benchmark::State& state, FormatFunction* format) {
  const std::string content = Join(format(TheMinute().output()));
  for (auto _ : state) benchmark::DoNotOptimize(ParseMmmMotionFile(content, "minute.xml"));
  CountBytes(state, content.size());
}

BENCHMARK(ReadC3d)->Unit(benchmark::kMillisecond);
BENCHMARK(ReadC3dRecording)->Unit(benchmark::kMillisecond);
BENCHMARK(WriteC3dRecording)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(FormatMotion, mmm_2_0, &FormatAlone)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(FormatMotion, mmm_1_0, &FormatMmmMotion1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(WriteMotion, mmm_2_0, &FormatAlone)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(FormatCsv)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ReadMotion, mmm_2_0, &FormatAlone)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ReadMotion, mmm_1_0, &FormatMmmMotion1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mmm_converter
