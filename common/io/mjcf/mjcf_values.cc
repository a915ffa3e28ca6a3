// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kLargestNumber = 1e9;  // of sizes [m], angles and masses: what no robot has
constexpr double kSmallestAxis = 1e-9;

const std::vector<std::string_view> kWays = {"axisangle", "euler", "xyaxes", "zaxis"};

bool IsEulerSequence(const std::string& text) {
  return text.size() == 3 && text.find_first_not_of("xyzXYZ") == std::string::npos;
}

Eigen::Vector3d UnitOf(char letter) {
  return Eigen::Vector3d::Unit(std::tolower(static_cast<unsigned char>(letter)) - 'x');
}

/// Small letters turn along with the frame, capitals about axes that stay.
Eigen::Quaterniond FromEuler(const std::string& sequence, const Eigen::Vector3d& angles) {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 3; ++i) {
    const char letter = sequence[static_cast<std::size_t>(i)];
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angles[i], UnitOf(letter)));
    q = letter >= 'a' ? q * turn : turn * q;
  }
  return q;
}

void ReadCompiler(const XmlElement& element, MjcfText* text, MjcfSettings* settings) {
  const auto is = [&](const char* name, const char* value) {
    const std::string* found = element.FindAttribute(name);
    return found != nullptr && *found == value;
  };
  if (is("angle", "radian")) settings->angle = 1;
  if (is("angle", "degree")) settings->angle = EIGEN_PI / 180;
  if (is("autolimits", "true")) settings->limits_by_range = true;
  if (is("autolimits", "false")) settings->limits_by_range = false;
  for (const char* folder : {"assetdir", "meshdir"}) {
    const std::string* found = element.FindAttribute(folder);
    if (found != nullptr) settings->mesh_folder = Trim(*found);
  }
  if (is("strippath", "true")) settings->strips_paths = true;
  if (is("strippath", "false")) settings->strips_paths = false;
  using Inertia = MjcfSettings::Inertia;
  if (is("inertiafromgeom", "true")) settings->inertia = Inertia::kFromGeoms;
  if (is("inertiafromgeom", "false")) settings->inertia = Inertia::kFromInertial;
  if (is("inertiafromgeom", "auto")) settings->inertia = Inertia::kAuto;
  if (is("coordinate", "global")) {
    text->Fail(element,
               "<compiler coordinate=\"global\"> is of an old version and not read; save "
               "the model with a newer MuJoCo");
  }
  const std::string* euler = element.FindAttribute("eulerseq");
  if (euler != nullptr && IsEulerSequence(*euler)) {
    settings->euler = *euler;
  } else if (euler != nullptr) {
    text->Fail(element,
               fmt::format("<compiler eulerseq=\"{}\">: use three letters of xyzXYZ", *euler));
  }
}

}  // namespace

MjcfSettings ReadMjcfSettings(const MjcfDefaults& defaults, MjcfText* text) {
  MjcfSettings settings;
  for (const XmlElement* element : text->root().FindChildren("compiler")) {
    ReadCompiler(*element, text, &settings);
    const MjcfAttributes attributes(*element, -1, defaults, settings, text);
    settings.total_mass = attributes.Number("settotalmass", settings.total_mass);
    if (const auto groups = attributes.Numbers("inertiagrouprange", 2, 2)) {
      settings.inertia_groups = {(*groups)[0], (*groups)[1]};
    }
  }
  return settings;
}

MjcfAttributes::MjcfAttributes(const XmlElement& element, int of_class,
                               const MjcfDefaults& defaults, const MjcfSettings& settings,
                               MjcfText* text)
    : element_(element), class_(of_class), defaults_(defaults), settings_(settings), text_(*text) {}

template <typename... Args>
void MjcfAttributes::Fail(Args&&... args) const {
  text_.Fail(element_, fmt::format(fmt::runtime("<{} {}=\"{}\">: {}"), element_.name,
                                   std::forward<Args>(args)...));
}

const std::string* MjcfAttributes::Find(std::string_view name) const {
  const std::string* own = element_.FindAttribute(name);
  return own != nullptr ? own : defaults_.Value(class_, ToLower(element_.name), name);
}

std::string MjcfAttributes::Word(std::string_view name, std::string_view otherwise) const {
  const std::string* text = Find(name);
  return std::string(text == nullptr ? otherwise : Trim(*text));
}

/// A shorter list replaces the first numbers of that of the class around it, as in MuJoCo.
std::optional<Eigen::VectorXd> MjcfAttributes::Numbers(std::string_view name, int fewest,
                                                       int most) const {
  std::vector<const std::string*> texts = defaults_.Values(class_, ToLower(element_.name), name);
  if (const std::string* own = element_.FindAttribute(name)) texts.push_back(own);
  if (texts.empty()) return {};
  std::vector<double> numbers;
  for (const std::string* text : texts) {
    std::vector<double> read;
    if (!AppendDoubles(*text, &read)) read.clear();
    const bool is_sane = std::all_of(
        read.begin(), read.end(), [](double number) { return std::abs(number) <= kLargestNumber; });
    if (read.empty() || read.size() > static_cast<std::size_t>(most) || !is_sane) {
      Fail(name, text->substr(0, 80), "are no numbers that a robot has here");
      return {};
    }
    numbers.resize(std::max(numbers.size(), read.size()));
    std::copy(read.begin(), read.end(), numbers.begin());
  }
  const auto count = static_cast<int>(numbers.size());
  if (count >= fewest) return Eigen::Map<const Eigen::VectorXd>(numbers.data(), count);
  Fail(name, texts.back()->substr(0, 80), fmt::format("use {} numbers", fewest));
  return {};
}

double MjcfAttributes::Number(std::string_view name, double otherwise) const {
  const auto numbers = Numbers(name, 1, 1);
  return numbers ? (*numbers)[0] : otherwise;
}

Eigen::Vector3d MjcfAttributes::Vector(std::string_view name,
                                       const Eigen::Vector3d& otherwise) const {
  const auto numbers = Numbers(name, 3, 3);
  return numbers ? Eigen::Vector3d(*numbers) : otherwise;
}

Eigen::Isometry3d MjcfAttributes::Pose() const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Vector("pos", Eigen::Vector3d::Zero());
  X.linear() = Orientation().toRotationMatrix();
  return X;
}

/// As MuJoCo has it: another way than quat goes before, even where it is of a class and a quat is
/// the element's own; of two others the element's own.
Eigen::Quaterniond MjcfAttributes::Orientation() const {
  std::string_view own;
  for (const std::string_view way : kWays) {
    if (element_.FindAttribute(way) == nullptr) continue;
    if (!own.empty() || element_.FindAttribute("quat") != nullptr) {
      text_.Fail(element_, fmt::format("<{}>: has its orientation twice", element_.name));
      return Eigen::Quaterniond::Identity();
    }
    own = way;
  }
  if (own.empty()) own = defaults_.FirstOf(class_, ToLower(element_.name), kWays);
  if (own.empty() && Find("quat") != nullptr) own = "quat";
  return own.empty() ? Eigen::Quaterniond::Identity() : OrientationBy(own);
}

Eigen::Quaterniond MjcfAttributes::OrientationBy(std::string_view way) const {
  const int count = way == "xyaxes" ? 6 : way == "quat" || way == "axisangle" ? 4 : 3;
  const auto found = Numbers(way, count, count);
  if (!found) return Eigen::Quaterniond::Identity();
  const Eigen::VectorXd& v = *found;
  if (way == "euler") return FromEuler(settings_.euler, settings_.angle * v);
  const Eigen::Vector3d first = v.head<3>();
  if ((way == "quat" ? v.norm() : first.norm()) > kSmallestAxis) {
    if (way == "quat") return Eigen::Quaterniond(v[0], v[1], v[2], v[3]).normalized();
    if (way == "zaxis") return TurnOfZ(first);
    if (way == "axisangle") {
      return Eigen::Quaterniond(Eigen::AngleAxisd(settings_.angle * v[3], first.normalized()));
    }
    Eigen::Matrix3d R;
    R.col(0) = first.normalized();
    const Eigen::Vector3d across = v.tail<3>() - R.col(0).dot(v.tail<3>()) * R.col(0);
    R.col(1) = across.normalized();
    R.col(2) = R.col(0).cross(R.col(1));
    if (across.norm() > kSmallestAxis) return Eigen::Quaterniond(R);
  }
  Fail(way, Find(way)->substr(0, 80), "has no direction");
  return Eigen::Quaterniond::Identity();
}

Eigen::Quaterniond TurnOfZ(const Eigen::Vector3d& to) {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ().cross(to);
  const double angle = std::atan2(axis.norm(), to.z());
  if (axis.norm() < kSmallestAxis * to.norm()) {
    return Eigen::Quaterniond(
        Eigen::AngleAxisd(to.z() < 0 ? EIGEN_PI : 0, Eigen::Vector3d::UnitX()));
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

}  // namespace mmm_converter
