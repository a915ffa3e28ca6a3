// SPDX-License-Identifier: MIT
// Makes a motion database like KIT's, of synthetic persons:
//
//   make_database FOLDER RECORDINGS SECONDS [SEED]
//
// writes FOLDER/files_motions_<person>/<motion>_<number>.c3d (ten recordings a person, 100 Hz),
// FOLDER/subjects.csv and FOLDER/manifest.xml. No two recordings are alike; the same arguments make
// the same bytes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_writer.h"
#include "common/math/rotation.h"
#include "common/math/seeded_random.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "common/support/atomic_file.h"
#include "common/support/parallel.h"
#include "tests/support/acrobatics.h"
#include "tests/support/changed_markers.h"
#include "tests/support/long_recording.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::testing {
namespace {

constexpr int kRecordingsPerPerson = 10;
constexpr double kNoise = 0.001;                        // [m]
constexpr testing::RandomOcclusion kGaps = {2e-4, 20};  // 0.4 % hidden, 0.2 s at a time

struct Options {
  std::string folder;
  int recordings = 0;
  double seconds = 0;
  int seed = 1;
};

struct Person {
  std::string id;
  double height;  // [m], whole centimetres
  double mass;    // [kg], whole kilograms
  std::vector<std::string> recordings = {};
};

struct NamedMotion {
  std::string name;
  PoseTrajectory trajectory;
};

std::uint64_t SeedOf(const Options& options, int person, int recording) {
  return (static_cast<std::uint64_t>(options.seed) * 1000000 + person) * 100 + recording;
}

Person DrawPerson(const Options& options, int index) {
  SeededRandom random(SeedOf(options, index, kRecordingsPerPerson));
  const double height = std::round(100 * (1.5 + 0.45 * random.Uniform())) / 100;
  const double body_mass_index = 19 + 9 * random.Uniform();
  return {fmt::format("{:04}", index + 1), height, std::round(body_mass_index * height * height)};
}

/// A window of a motion that is played back and forth, anywhere on the floor.
PoseTrajectory PlayElsewhere(const PoseTrajectory& motion, int frames, SeededRandom* random) {
  PoseTrajectory played = motion;
  played.postures.clear();
  const int first = random->UniformIndex(motion.num_frames());
  const Eigen::Quaterniond heading = Exp({0, 0, 2 * std::numbers::pi * random->Uniform()});
  const Eigen::Vector3d place(2 * random->Uniform() - 1, 2 * random->Uniform() - 1, 0);
  played.postures.reserve(frames);
  for (int k = 0; k < frames; ++k) {
    Posture posture = motion.postures[FrameBackAndForth(first + k, motion.num_frames())];
    posture.position = heading * posture.position + place;
    posture.orientation = heading * posture.orientation;
    played.postures.push_back(posture);
  }
  return played;
}

/// Writes recordings [first, last) of the database, those of one person.
void Record(const Options& options, int index, Person* person) {
  const int first = index * kRecordingsPerPerson;
  const int count = std::min(kRecordingsPerPerson, options.recordings - first);
  const KinematicModel model = ScaledReferenceModel(person->height);
  const std::vector<NamedMotion> motions = {
      {"handstand", MakeHandstand(model)},
      {"cartwheel", testing::MakeCartwheel(model)},
      {"range", RangeOfMotion(model, 20, 0.7, SeedOf(options, index, 0))}};
  const std::string folder = "files_motions_" + person->id;
  std::filesystem::create_directories(options.folder + "/" + folder);
  for (int r = 0; r < count; ++r) {
    const NamedMotion& motion = motions[r % motions.size()];
    const std::uint64_t seed = SeedOf(options, index, r);
    SeededRandom random(seed);
    MarkerErrors errors;
    errors.noise = kNoise;
    const int frames = static_cast<int>(std::lround(options.seconds * motion.trajectory.rate));
    const MarkerSequence markers =
        SynthesizeMarkers(model, PlayElsewhere(motion.trajectory, frames, &random), errors, seed);
    person->recordings.push_back(fmt::format("{}/{}_{:02}.c3d", folder, motion.name, r + 1));
    WriteC3d(options.folder + "/" + person->recordings.back(),
             testing::OccludeAtRandom(markers, kGaps, seed),
             {.comment = "Synthetic: not a recorded person."});
  }
}

std::string FormatSubjects(const std::vector<Person>& persons) {
  std::string csv = "folder,height_m,mass_kg\n";
  for (const Person& person : persons) {
    fmt::format_to(std::back_inserter(csv), "files_motions_{},{:.2f},{:.0f}\n", person.id,
                   person.height, person.mass);
  }
  return csv;
}

std::string FormatManifest(const std::vector<Person>& persons) {
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  xml += "<Batch name=\"synthetic\" config=\"s2kf_default\">\n";
  for (const Person& person : persons) {
    fmt::format_to(std::back_inserter(xml),
                   "  <Group name=\"{}\" height_m=\"{:.2f}\" mass_kg=\"{:.0f}\">\n", person.id,
                   person.height, person.mass);
    for (const std::string& file : person.recordings) {
      fmt::format_to(std::back_inserter(xml), "    <Recording file=\"{}\"/>\n", file);
    }
    xml += "  </Group>\n";
  }
  return xml + "</Batch>\n";
}

void MakeDatabase(const Options& options) {
  const int count = (options.recordings + kRecordingsPerPerson - 1) / kRecordingsPerPerson;
  std::vector<Person> persons;
  persons.reserve(count);
  for (int i = 0; i < count; ++i) persons.push_back(DrawPerson(options, i));
  std::filesystem::create_directories(options.folder);
  ParallelFor(count, 0, [&](int i) { Record(options, i, &persons[i]); });
  WriteFileAtomically(options.folder + "/subjects.csv", FormatSubjects(persons));
  WriteFileAtomically(options.folder + "/manifest.xml", FormatManifest(persons));
}

}  // namespace
}  // namespace mmm_converter::testing

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) {
    std::cerr << "use: make_database FOLDER RECORDINGS SECONDS [SEED]\n";
    return 2;
  }
  try {
    mmm_converter::testing::Options options;
    options.folder = argv[1];
    options.recordings = std::stoi(argv[2]);
    options.seconds = std::stod(argv[3]);
    if (argc == 5) options.seed = std::stoi(argv[4]);
    mmm_converter::testing::MakeDatabase(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
