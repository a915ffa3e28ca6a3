// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_model_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_document.h"
#include "common/math/up_axis.h"
#include "common/model/body_bounds.h"
#include "common/model/coordinate_map.h"
#include "common/support/error.h"
#include "common/support/error_of_file.h"
#include "common/support/text.h"

namespace mmm_converter {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// What the coordinates of a model are when its locks and couplers hold: constant, free, or
/// functions of free ones.
class OsimCouplings {
 public:
  /// Errors of couplers are added to the diagnostics.
  OsimCouplings(const OsimDocument& document, Diagnostics* diagnostics);

  int Find(const std::string& coordinate) const;  ///< index; -1: there is none
  bool IsFree(int coordinate) const { return is_free_[coordinate]; }
  /// The value of a coordinate by free ones only.
  const OsimExpression& ValueOf(int coordinate) const { return values_[coordinate]; }
  /// An expression in free coordinates that the document has in any. Terms that are straight have
  /// no constant of their own. line: for an error, where that can't be said by sums.
  OsimExpression InFree(const OsimExpression& expression, int line);

 private:
  void AddTerm(const OsimExpression::Term& term, int line, OsimExpression* sum);
  void Couple(const std::vector<const OsimCoupler*>& coupler_of);

  std::map<std::string, int> index_;
  Diagnostics* diagnostics_;
  std::vector<bool> is_free_;
  std::vector<OsimExpression> values_;
};

// Real models have 1, and splines of some 20 points. Chains of couplers could multiply both.
constexpr std::size_t kMostTerms = 16;
constexpr std::size_t kMostNumbers = 4096;
constexpr int kLongestCoupling = 16;  // of couplers; real models have 1

OsimCouplings::OsimCouplings(const OsimDocument& document, Diagnostics* diagnostics)
    : diagnostics_(diagnostics) {
  const std::size_t count = document.coordinates.size();
  is_free_.assign(count, true);
  values_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const OsimCoordinate& one = document.coordinates[i];
    index_.emplace(one.name, static_cast<int>(i));
    is_free_[i] = !one.IsHeld();
    values_[i].constant = one.is_locked ? one.default_value : one.lower;
    if (one.IsHeld()) continue;
    values_[i] = OsimExpression();
    values_[i].terms.push_back({one.name, ScalarFunction()});
  }
  std::vector<const OsimCoupler*> coupler_of(count, nullptr);
  for (const OsimCoupler& coupler : document.couplers) {
    const int dependent = Find(coupler.dependent);
    std::string unknown = dependent < 0 ? coupler.dependent : "";
    for (const auto& term : coupler.value.terms) {
      if (Find(term.coordinate) < 0) unknown = term.coordinate;
    }
    if (!unknown.empty() || dependent < 0) {
      diagnostics->AddError(coupler.line, fmt::format("coupler '{}': the model has no coordinate "
                                                      "\"{}\"",
                                                      coupler.name, unknown));
    } else if (coupler_of[dependent] != nullptr) {
      diagnostics->AddError(
          coupler.line, fmt::format("coupler '{}': coordinate '{}' follows '{}' already",
                                    coupler.name, coupler.dependent, coupler_of[dependent]->name));
    } else if (is_free_[dependent]) {
      coupler_of[dependent] = &coupler;
      is_free_[dependent] = false;
    }
  }
  if (diagnostics->errors().empty()) Couple(coupler_of);
}

/// Chain by chain, from what is known on.
void OsimCouplings::Couple(const std::vector<const OsimCoupler*>& coupler_of) {
  std::vector<std::vector<int>> followers(coupler_of.size());
  std::vector<int> open(coupler_of.size(), 0);  // leaders that are not known yet
  std::vector<int> chain(coupler_of.size(), 1);
  std::vector<int> known;
  std::size_t waiting = 0;
  for (std::size_t i = 0; i < coupler_of.size(); ++i) {
    if (coupler_of[i] == nullptr) continue;
    ++waiting;
    for (const auto& term : coupler_of[i]->value.terms) {
      const int leader = Find(term.coordinate);
      if (coupler_of[leader] == nullptr) continue;
      followers[leader].push_back(static_cast<int>(i));
      ++open[i];
    }
    if (open[i] == 0) known.push_back(static_cast<int>(i));
  }
  while (!known.empty()) {
    const int one = known.back();
    known.pop_back();
    --waiting;
    values_[one] = InFree(coupler_of[one]->value, coupler_of[one]->line);
    if (chain[one] > kLongestCoupling) {
      diagnostics_->AddError(coupler_of[one]->line,
                             fmt::format("coupler '{}' follows more than {} others one by one",
                                         coupler_of[one]->name, kLongestCoupling));
      return;
    }
    for (const int follower : followers[one]) {
      chain[follower] = std::max(chain[follower], chain[one] + 1);
      if (--open[follower] == 0) known.push_back(follower);
    }
  }
  if (waiting == 0) return;
  for (std::size_t i = 0; i < coupler_of.size(); ++i) {
    if (open[i] == 0) continue;
    diagnostics_->AddError(coupler_of[i]->line,
                           fmt::format("coupler '{}': coordinate '{}' follows itself by way of "
                                       "other couplers",
                                       coupler_of[i]->name, coupler_of[i]->dependent));
    return;
  }
}

int OsimCouplings::Find(const std::string& coordinate) const {
  const auto found = index_.find(coordinate);
  return found == index_.end() ? -1 : found->second;
}

void OsimCouplings::AddTerm(const OsimExpression::Term& term, int line, OsimExpression* sum) {
  const int index = Find(term.coordinate);
  if (index < 0) return;
  const OsimExpression& value = values_[index];
  const auto straight = term.function.AsLine();
  if (value.terms.empty()) {
    sum->constant += term.function.Value(value.constant);
  } else if (straight) {
    sum->constant += straight->slope * value.constant + straight->offset;
    if (straight->slope == 0) return;
    for (const auto& one : value.terms) {
      sum->terms.push_back({one.coordinate, one.function.Scaled(straight->slope)});
    }
  } else if (value.terms.size() == 1) {
    const auto& one = value.terms.front();
    const ScalarFunction inner = ScalarFunction::Linear(1, value.constant).After(one.function);
    sum->terms.push_back({one.coordinate, term.function.After(inner)});
  } else {
    diagnostics_->AddError(line, fmt::format("a function that is not linear of coordinate '{}', "
                                             "which follows several others, is not read",
                                             term.coordinate));
  }
}

OsimExpression OsimCouplings::InFree(const OsimExpression& expression, int line) {
  OsimExpression sum;
  sum.constant = expression.constant;
  for (const auto& term : expression.terms) AddTerm(term, line, &sum);
  std::size_t numbers = 0;
  for (const auto& term : sum.terms) numbers += term.function.size();
  if (sum.terms.size() > kMostTerms || numbers > kMostNumbers) {
    diagnostics_->AddError(line, fmt::format("what moves here is a sum of {} functions of {} "
                                             "numbers, more than the {} of {} that are read",
                                             sum.terms.size(), numbers, kMostTerms, kMostNumbers));
    return {};
  }
  for (auto& term : sum.terms) {
    const auto straight = term.function.AsLine();
    if (!straight) continue;
    sum.constant += straight->offset;
    term.function = ScalarFunction::Linear(straight->slope, 0);
  }
  return sum;
}

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kRightAngle = 1e-9;  // cosine of it, of axes that files have with 15 digits
// OpenSim takes a default that is no farther outside of its range for rounding.
constexpr double kRangeTolerance = 1.5e-8;
// What a coordinate without limits reaches, where its range says less or more [rad, m].
constexpr double kLeastReach = 0.1, kMostTurn = EIGEN_PI, kMostShift = 1;

UpAxis UpOf(const Vector3d& gravity) {
  constexpr UpAxis kUp[] = {UpAxis::kX, UpAxis::kY, UpAxis::kZ};
  constexpr UpAxis kDown[] = {UpAxis::kMinusX, UpAxis::kMinusY, UpAxis::kMinusZ};
  if (gravity.isZero(0)) return UpAxis::kY;
  int axis = 0;
  gravity.cwiseAbs().maxCoeff(&axis);
  return gravity[axis] < 0 ? kUp[axis] : kDown[axis];
}

class ModelBuilder {
 public:
  ModelBuilder(const OsimDocument& document, Diagnostics* diagnostics)
      : document_(document),
        diagnostics_(diagnostics),
        couplings_(document, diagnostics),
        R_WG_(RotationToZUp(UpOf(document.gravity))) {}

  KinematicModel Build();

 private:
  std::vector<int> OrderJoints();
  std::optional<FreeRoot> FindFreeRoot(const OsimJoint& joint);
  bool TakeRootAxis(const OsimAxis& axis, int index, FreeRoot* root);
  void AddJoint(const OsimJoint& joint);
  void AddAxis(const OsimJoint& joint, const OsimAxis& axis, bool is_turn, int* parent,
               Isometry3d* X);
  void ChooseLeaders();
  void SetRange(int coordinate, Segment* segment);
  int AddBody(int body, int parent, const Isometry3d& X);
  void AddMarkers();
  std::shared_ptr<const CoordinateMap> MapCoordinates();
  std::string UniqueName(std::string name);

  const OsimDocument& document_;
  Diagnostics* diagnostics_;
  OsimCouplings couplings_;
  Matrix3d R_WG_;
  ModelDescription description_;
  std::optional<FreeRoot> root_;
  std::map<std::string, int> root_index_;  // of the root's coordinates
  std::vector<int> segment_of_body_;
  std::map<std::string, std::vector<int>> moved_by_;  // segments, by free coordinate
  std::set<std::string> names_;                       // of segments
};

std::string ModelBuilder::UniqueName(std::string name) {
  while (!names_.insert(name).second) name += "_";
  return name;
}

/// Joints whose parents come before them.
std::vector<int> ModelBuilder::OrderJoints() {
  const std::size_t bodies = document_.bodies.size();
  std::vector<int> joint_of(bodies, -1);
  std::vector<std::vector<int>> below(bodies);
  for (std::size_t j = 0; j < document_.joints.size(); ++j) {
    const OsimJoint& joint = document_.joints[j];
    if (joint.child == 0) {
      diagnostics_->AddError(joint.line, fmt::format("joint '{}' carries the ground; exchange its "
                                                     "parent and child",
                                                     joint.name));
    } else if (joint_of[joint.child] >= 0) {
      diagnostics_->AddError(
          joint.line,
          fmt::format("joint '{}' carries body '{}', which joint '{}' carries already: loops are "
                      "not read",
                      joint.name, document_.bodies[joint.child].name,
                      document_.joints[joint_of[joint.child]].name));
    } else {
      joint_of[joint.child] = static_cast<int>(j);
      below[joint.parent].push_back(static_cast<int>(j));
    }
  }
  std::vector<int> order(below[0]);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::vector<int>& next = below[document_.joints[order[i]].child];
    order.insert(order.end(), next.begin(), next.end());
  }
  if (order.size() + 1 == bodies) return order;
  std::set<int> reached;
  for (const int joint : order) reached.insert(document_.joints[joint].child);
  for (std::size_t b = 1; b < bodies; ++b) {
    if (reached.count(static_cast<int>(b)) > 0) continue;
    const OsimBody& body = document_.bodies[b];
    diagnostics_->AddError(body.line,
                           joint_of[b] < 0
                               ? fmt::format("body '{}' has no joint that carries it", body.name)
                               : fmt::format("body '{}' hangs in a circle of joints", body.name));
  }
  return order;
}

bool ModelBuilder::TakeRootAxis(const OsimAxis& axis, int index, FreeRoot* root) {
  if (axis.value.terms.size() != 1) return false;
  const auto& term = axis.value.terms.front();
  const auto line = term.function.AsLine();
  const int coordinate = couplings_.Find(term.coordinate);
  if (!line || line->slope == 0 || !couplings_.IsFree(coordinate)) return false;
  if (!root_index_.emplace(term.coordinate, index).second) return false;
  root->slope[index] = line->slope;
  root->offset[index] = line->offset + axis.value.constant;
  (index < 3 ? root->turns.col(index) : root->shifts.col(index - 3)) = axis.axis;
  return true;
}

/// Six free coordinates that tell any pose, one by each axis, and nothing else.
std::optional<FreeRoot> ModelBuilder::FindFreeRoot(const OsimJoint& joint) {
  FreeRoot root;
  bool is_free = joint.coordinates.size() == 6;
  for (int i = 0; i < 3; ++i) {
    is_free = is_free && TakeRootAxis(joint.rotations[i], i, &root) &&
              TakeRootAxis(joint.translations[i], 3 + i, &root);
  }
  const Matrix3d turned = root.turns.transpose() * root.turns;
  is_free = is_free && turned.isIdentity(kRightAngle) &&
            std::abs(root.shifts.determinant()) > kRightAngle;
  for (const OsimCoupler& coupler : document_.couplers) {
    for (const auto& term : coupler.value.terms) {
      is_free = is_free && root_index_.count(term.coordinate) == 0;
    }
  }
  if (!is_free) {
    root_index_.clear();
    return std::nullopt;
  }
  root.X_WF = R_WG_ * joint.X_PF;
  root.X_MS = joint.X_CM.inverse();
  return root;
}

int ModelBuilder::AddBody(int body, int parent, const Isometry3d& X) {
  const OsimBody& source = document_.bodies[body];
  Segment& segment = description_.segments.emplace_back();
  segment.name = UniqueName(source.name);
  segment.parent = parent;
  segment.X_PF = X;
  segment.mass = source.mass;
  segment.p_SB = source.p_BC;
  segment.inertia = source.inertia;
  segment_of_body_[body] = static_cast<int>(description_.segments.size()) - 1;
  return segment_of_body_[body];
}

void ModelBuilder::SetRange(int coordinate, Segment* segment) {
  const OsimCoordinate& one = document_.coordinates[coordinate];
  const bool is_limited = one.is_clamped && std::isfinite(one.lower) && std::isfinite(one.upper);
  segment->rest = one.default_value;
  if (is_limited) {
    segment->lower = one.lower;
    segment->upper = one.upper;
    if (one.default_value < one.lower - kRangeTolerance ||
        one.default_value > one.upper + kRangeTolerance) {
      diagnostics_->AddWarning(
          one.line, fmt::format("coordinate '{}': its default {:g} is outside of its range {:g} to "
                                "{:g}, in which it is clamped",
                                one.name, one.default_value, one.lower, one.upper));
    }
    segment->rest = std::clamp(segment->rest, one.lower, one.upper);
    return;
  }
  segment->lower = -kEndless;
  segment->upper = kEndless;
  const double most = segment->type == JointType::kSliding ? kMostShift : kMostTurn;
  const double half = 0.5 * (one.upper - one.lower);
  segment->reach = std::isfinite(half) ? std::clamp(half, kLeastReach, most) : most;
}

/// Segments for what an axis turns or shifts by; what is constant goes into X, the frame that the
/// next one starts from.
void ModelBuilder::AddAxis(const OsimJoint& joint, const OsimAxis& axis, bool is_turn, int* parent,
                           Isometry3d* X) {
  const OsimExpression value = couplings_.InFree(axis.value, joint.line);
  if (is_turn) {
    X->rotate(Eigen::AngleAxisd(value.constant, axis.axis));
  } else {
    X->translate(value.constant * axis.axis);
  }
  for (const auto& term : value.terms) {
    const auto index = static_cast<int>(description_.segments.size());
    Segment& segment = description_.segments.emplace_back();
    segment.name = joint.name + "/" + term.coordinate;
    segment.parent = *parent;
    segment.X_PF = *X;
    segment.type = is_turn ? JointType::kRevolute : JointType::kSliding;
    segment.axis = axis.axis;
    const auto line = term.function.AsLine();
    if (line && line->slope == -1) {
      segment.axis = -axis.axis;
    } else if (!line || line->slope != 1) {
      segment.function = std::make_shared<const ScalarFunction>(term.function);
    }
    moved_by_[term.coordinate].push_back(index);
    *parent = index;
    *X = Isometry3d::Identity();
  }
}

/// One of the segments that a coordinate moves gets its name and range: where there is one, a
/// segment whose turn or shift is the coordinate itself.
void ModelBuilder::ChooseLeaders() {
  for (const auto& [name, moved] : moved_by_) {
    int leader = moved.front();
    for (const int index : moved) {
      if (description_.segments[index].function != nullptr) continue;
      leader = index;
      break;
    }
    Segment& first = description_.segments[leader];
    SetRange(couplings_.Find(name), &first);
    first.name = name;
    for (const int index : moved) {
      if (index == leader) continue;
      Segment& segment = description_.segments[index];
      segment.leader = leader;
      segment.name = UniqueName(segment.name);
      segment.lower = first.lower;
      segment.upper = first.upper;
      segment.rest = first.rest;
      segment.reach = first.reach;
    }
  }
}

void ModelBuilder::AddJoint(const OsimJoint& joint) {
  int parent = segment_of_body_[joint.parent];
  Isometry3d X = joint.X_PF;
  for (const OsimAxis& axis : joint.translations) AddAxis(joint, axis, false, &parent, &X);
  for (const OsimAxis& axis : joint.rotations) AddAxis(joint, axis, true, &parent, &X);
  AddBody(joint.child, parent, X * joint.X_CM.inverse());
}

void ModelBuilder::AddMarkers() {
  std::vector<std::string> lost;
  for (const OsimMarker& source : document_.markers) {
    if (segment_of_body_[source.body] < 0) {
      lost.push_back(source.name);
      continue;
    }
    ModelMarker& marker = description_.markers.emplace_back();
    marker.name = source.name;
    marker.segment = segment_of_body_[source.body];
    marker.p_SM = source.p_BM;
  }
  if (lost.empty()) return;
  diagnostics_->AddWarning(0,
                           fmt::format("markers on the ground are not used: {}", FirstNames(lost)));
}

std::shared_ptr<const CoordinateMap> ModelBuilder::MapCoordinates() {
  constexpr ModelCoordinate::Kind kKinds[] = {
      ModelCoordinate::Kind::kTurn, ModelCoordinate::Kind::kShift, ModelCoordinate::Kind::kCoupled};
  std::vector<ModelCoordinate> coordinates;
  for (std::size_t i = 0; i < document_.coordinates.size(); ++i) {
    const OsimCoordinate& source = document_.coordinates[i];
    ModelCoordinate& one = coordinates.emplace_back();
    one.name = source.name;
    one.kind = kKinds[static_cast<int>(source.motion_type)];
    one.rest = source.default_value;
    one.lower = source.lower;
    one.upper = source.upper;
    one.is_clamped = source.is_clamped;
    one.is_locked = source.is_locked;
    if (const auto root = root_index_.find(one.name); root != root_index_.end()) {
      one.root = root->second;
      continue;
    }
    const OsimExpression& value = couplings_.ValueOf(static_cast<int>(i));
    one.constant = value.constant;
    for (const auto& term : value.terms) {
      if (moved_by_.count(term.coordinate) > 0) {
        one.terms.push_back({term.coordinate, term.function});
      } else {  // moves nothing, and is where it is
        const int leader = couplings_.Find(term.coordinate);
        one.constant += term.function.Value(document_.coordinates[leader].default_value);
      }
    }
    if (!IsWithin(one.constant, kFarthestTurn)) {
      diagnostics_->AddError(source.line,
                             fmt::format("coordinate '{}': what it follows puts it at {:g}, beyond "
                                         "what a body can do",
                                         one.name, one.constant));
    }
  }
  return std::make_shared<const CoordinateMap>(std::move(coordinates), root_, R_WG_);
}

KinematicModel ModelBuilder::Build() {
  if (document_.bodies.size() < 2) {
    throw Error(fmt::format("{}: the model has no bodies", diagnostics_->file()));
  }
  const std::vector<int> order = OrderJoints();
  diagnostics_->ThrowIfErrors();
  description_.name = document_.name.empty() ? "unnamed" : document_.name;
  segment_of_body_.assign(document_.bodies.size(), -1);
  for (const OsimCoordinate& one : document_.coordinates) names_.insert(one.name);
  std::size_t first = 0;
  const bool is_alone = std::count_if(order.begin(), order.end(), [&](int joint) {
                          return document_.joints[joint].parent == 0;
                        }) == 1;
  if (is_alone) root_ = FindFreeRoot(document_.joints[order.front()]);
  if (root_) {
    AddBody(document_.joints[order[first++]].child, -1, Isometry3d::Identity());
  } else {
    AddBody(0, -1, Isometry3d(R_WG_));
    description_.is_root_fixed = true;
  }
  for (; first < order.size(); ++first) AddJoint(document_.joints[order[first]]);
  ChooseLeaders();
  AddMarkers();
  description_.coordinates = MapCoordinates();
  diagnostics_->ThrowIfErrors();
  return KinematicModel(std::move(description_));
}

}  // namespace

KinematicModel MakeOsimModel(const OsimDocument& document, Diagnostics* diagnostics) {
  return OfFile(diagnostics->file(), [&] { return ModelBuilder(document, diagnostics).Build(); });
}

OsimDocument ParseOsimDocument(std::string_view content, const std::string& marker_file,
                               Diagnostics* diagnostics, Warnings* warnings) {
  const auto read_part = [diagnostics](const std::string& name) {
    const std::filesystem::path path =
        std::filesystem::path(diagnostics->file()).parent_path() / name;
    return ReadFileContent(path.string(), kMaxOsimBytes);
  };
  OsimDocument document = ParseOsim(content, read_part, diagnostics);
  if (!marker_file.empty()) {
    AddOsimMarkers(ReadFileContent(marker_file, kMaxOsimBytes), marker_file, &document, warnings);
  }
  return document;
}

KinematicModel ParseOsimModel(std::string_view content, const std::string& file,
                              const std::string& marker_file, Warnings* warnings) {
  Diagnostics diagnostics(file, warnings);
  return MakeOsimModel(ParseOsimDocument(content, marker_file, &diagnostics, warnings),
                       &diagnostics);
}

KinematicModel ReadOsimModel(const std::string& path, const std::string& marker_file,
                             Warnings* warnings) {
  return ParseOsimModel(ReadFileContent(path, kMaxOsimBytes), path, marker_file, warnings);
}

}  // namespace mmm_converter
