// SPDX-License-Identifier: MIT
// `label` on a cloud of points of two persons and a box: the sample, a smaller person beside who
// moves the other way through it, and a box that turns above them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording.h"
#include "common/math/rotation.h"
#include "common/math/seeded_random.h"
#include "tests/cli/program.h"

namespace mmm_converter::testing {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr int kFrames = 60;
constexpr double kSmaller = 0.93;

std::string SceneFile(const std::string& name) { return TestFolder() + "/" + name; }

/// The sample's first frames as somebody of another height does them, moved along x.
MarkerSequence Person(double scale, bool backward, double x, int frames = kFrames) {
  const MarkerSequence sample = ReadRecording(Handstand(), {}).markers;
  MarkerSequence person(sample.labels(), frames, sample.rate(), 0);
  for (int k = 0; k < frames; ++k) {
    const int from = backward ? frames - 1 - k : k;
    person.frame(k) = (scale * sample.frame(from)).colwise() + Vector3d(x, 0, 0);
  }
  return person;
}

MarkerSequence Box() {
  Eigen::Matrix3Xd p_OM(3, 4);
  p_OM << 0, 0.16, 0.01, -0.05, 0.02, -0.01, 0.09, 0, 0, 0.03, 0.05, 0.12;
  MarkerSequence box({"1", "2", "3", "4"}, kFrames, 100, 0);
  for (int k = 0; k < kFrames; ++k) {
    const Eigen::Matrix3d R = Exp(Vector3d(0.01 * k, 0, 0.02 * k)).toRotationMatrix();
    box.frame(k) = (R * p_OM).colwise() + Vector3d(1 + 0.005 * k, 0.2, 1.9);
  }
  return box;
}

/// All points as the columns "*1", "*2", ... in an order that changes every 40 frames.
std::string WriteCloud(const std::vector<MarkerSequence>& bodies) {
  std::vector<std::string> labels;
  for (const MarkerSequence& body : bodies) {
    for (int i = 0; i < body.num_labels(); ++i) {
      labels.push_back("*" + std::to_string(labels.size() + 1));
    }
  }
  MarkerSequence cloud(labels, kFrames, 100, 0);
  SeededRandom random(11);
  std::vector<int> order(labels.size());
  for (int k = 0; k < kFrames; ++k) {
    if (k % 40 == 0) {
      for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
      for (std::size_t i = order.size() - 1; i > 0; --i) {
        std::swap(order[i], order[random.UniformIndex(static_cast<int>(i) + 1)]);
      }
    }
    int column = 0;
    for (const MarkerSequence& body : bodies) {
      for (int i = 0; i < body.num_labels(); ++i) {
        cloud.frame(k).col(order[column++]) = body.frame(k).col(i);
      }
    }
  }
  std::string path = SceneFile("cloud.c3d");
  WriteC3d(path, cloud);
  return path;
}

/// Share of the truth that a subject of a file has at its place, of what it has at all.
void ExpectSubject(const std::string& file, const std::string& subject,
                   const MarkerSequence& truth) {
  ReadRecordingOptions options;
  options.subject = subject;
  const MarkerSequence found = ReadRecording(file, options).markers;
  int right = 0, wrong = 0;
  for (int i = 0; i < found.num_labels(); ++i) {
    const int label = truth.FindLabel(found.labels()[i]);
    ASSERT_GE(label, 0) << found.labels()[i];
    for (int k = 0; k < kFrames; ++k) {
      const Vector3d p = found.frame(k).col(i);
      if (!IsSeen(p)) continue;
      ((p - truth.frame(k).col(label)).norm() < 1e-4 ? right : wrong) += 1;
    }
  }
  EXPECT_GE(right, 0.99 * truth.num_labels() * kFrames) << subject;
  EXPECT_LE(wrong, 0.001 * truth.num_labels() * kFrames) << subject;
}

void ExpectRuns(const std::vector<std::string>& arguments) {
  const ProgramRun run = RunProgram(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.err;
}

TEST(LabelScene, PersonsAndObjectsOfOneCloudAreNamedApart) {
  const MarkerSequence anna = Person(1, false, 0);
  const MarkerSequence ben = Person(kSmaller, true, 2);
  const MarkerSequence box = Box();
  for (const auto& [name, scale, height] :
       {std::tuple("anna", 1.0, "1.8"), std::tuple("ben", kSmaller, "1.674")}) {
    constexpr int kToCalibrateOn = 500;
    const std::string file = SceneFile(std::string(name) + ".c3d");
    WriteC3d(file, Person(scale, false, 0, kToCalibrateOn));
    ExpectRuns({"calibrate", file, "--height", height, "--name", name, "-o",
                SceneFile(std::string(name) + ".xml")});
  }
  WriteC3d(SceneFile("box.c3d"), box);
  ExpectRuns({"convert", SceneFile("box.c3d"), "--object", "--object-models", SceneFile("objects"),
              "-o", SceneFile("box_motion.xml")});

  const std::string cloud = WriteCloud({anna, ben, box});
  const std::string output = SceneFile("named.c3d");
  const std::string summary = SceneFile("named.json");
  const ProgramRun run = RunProgram({"label", cloud, "--subject-file", SceneFile("anna.xml"),
                                     "--and-subject-file", SceneFile("ben.xml"), "--object-models",
                                     SceneFile("objects"), "-o", output, "--summary", summary});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("person     ben ("), HasSubstr("53 of 53 names found"),
                             HasSubstr("object     box ("), HasSubstr("4 of 4 names found")));
  EXPECT_EQ(nlohmann::json::parse(ReadText(summary)).at("others").size(), 2);
  ExpectSubject(output, "anna", anna);
  ExpectSubject(output, "ben", ben);
  ExpectSubject(output, "box", box);

  // In one step, and as a user goes on.
  ExpectRuns({"convert", cloud, "--label", "--subject-file", SceneFile("ben.xml"),
              "--and-subject-file", SceneFile("anna.xml"), "--object-models", SceneFile("objects"),
              "-o", SceneFile("ben_only.xml"), "--summary", SceneFile("ben_only.json")});
  const auto only = nlohmann::json::parse(ReadText(SceneFile("ben_only.json")));
  EXPECT_THAT(only.at("markers").at("used"), SizeIs(53));
  EXPECT_LT(only.at("distance_mm").at("mean"), 5);
  ExpectRuns({"convert", output, "--subject", "ben", "--subject-file", SceneFile("ben.xml"),
              "--frames", ":20", "-o", SceneFile("ben_motion.xml")});
  ExpectRuns({"convert", output, "--subject", "box", "--object", "--object-models",
              SceneFile("objects"), "-o", SceneFile("box_again.xml")});

  const auto expect = [&](const std::vector<std::string>& arguments, const std::string& said) {
    std::vector<std::string> words = {"label", cloud, "--subject-file", SceneFile("anna.xml")};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const ProgramRun refused = RunProgram(words);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.err, HasSubstr(said));
  };
  expect({"--and-subject-file", SceneFile("anna.xml")}, "is called anna, too");
  expect({"--and-subject-file", SceneFile("ben.xml"), "-o", SceneFile("out.xml")},
         "each is then a --subject");
  expect({"--and-subject-file", SceneFile("ben.xml"), "--repair"}, "one person at a time");
  expect({"--object-models", SceneFile("nowhere")}, "can't be read: No such file");
  expect({"--object-models", TestFolder()}, "here; " + SceneFile("anna.xml"));
  EXPECT_EQ(RunProgram({"convert", cloud, "--and-subject-file", SceneFile("ben.xml")}).exit_code,
            2);
  expect({"--and-subject-file", SceneFile("ben.xml"), "--summary", SceneFile("ben.xml")},
         "is read");
  expect({"--object-models", SceneFile("objects"), "--report", SceneFile("objects/box.xml")},
         "is read");
}

}  // namespace
}  // namespace mmm_converter::testing
