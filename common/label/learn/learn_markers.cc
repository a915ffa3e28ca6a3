// SPDX-License-Identifier: MIT
#include "common/label/learn/learn_markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <tuple>

#include "common/label/learn/body_sites.h"
#include "common/label/learn/computed_points.h"
#include "common/label/learn/learn_doubts.h"
#include "common/label/learn/learn_frames.h"
#include "common/label/learn/learned_places.h"
#include "common/label/learn/named_places.h"
#include "common/label/search/body_search.h"
#include "common/label/tuning.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;

namespace {

/// The model's markers but for those at the ends of limbs, one of each is enough: hardly any set
/// has several, and they would be looked for among the markers above.
std::vector<MarkerAssignment> UsualMarkers(const BodySites& sites) {
  std::vector<int> chosen;
  for (int s = 0; s < static_cast<int>(sites.sites().size()); ++s) {
    const BodySite& site = sites.sites()[s];
    const bool is_last = std::none_of(sites.sites().begin(), sites.sites().end(),
                                      [s](const BodySite& other) { return other.parent == s; });
    const std::size_t count = is_last && site.mirror >= 0 ? 1 : site.markers.size();
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(site.markers[i]);
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<MarkerAssignment> assignments;
  assignments.reserve(chosen.size());
  for (const int m : chosen) assignments.push_back({LabelIx(m), MarkerIx(m), 1.0});
  return assignments;
}

std::vector<MarkerAssignment> AllMarkers(const KinematicModel& model) {
  std::vector<MarkerAssignment> assignments;
  assignments.reserve(model.markers().size());
  for (int m = 0; m < static_cast<int>(model.markers().size()); ++m) {
    assignments.push_back({LabelIx(m), MarkerIx(m), 1.0});
  }
  return assignments;
}

LabelBody MakeBody(const BodySites& sites, std::vector<MarkerAssignment> assignments) {
  TrackingSetup setup;
  setup.model = std::make_shared<const KinematicModel>(sites.model());
  setup.joints = sites.joints();
  setup.mapping.assignments = std::move(assignments);
  return LabelBody(setup);
}

/// Finds the body in a frame: with the model's own markers, if it wears these, or with others.
class AnyBodySearch {
 public:
  explicit AnyBodySearch(const BodySites& sites)
      : own_body_(MakeBody(sites, AllMarkers(sites.model()))),
        other_body_(MakeBody(sites, UsualMarkers(sites))),
        own_(own_body_, LimbRestarts::kWithWholeBody),
        other_((other_body_.place.setConstant(LearnTuning::kAnyPlace), other_body_),
               LimbRestarts::kWithWholeBody) {}

  Posture Find(const Matrix3Xd& points) {
    if (points.cols() >= own_body_.num_markers()) {
      const BodyMatch match = own_.Find(points);
      if (match.matched == own_body_.num_markers() &&
          match.cost < LearnTuning::kOwnCost * match.matched) {
        return match.posture;
      }
    }
    return other_.Find(points).posture;
  }

 private:
  LabelBody own_body_, other_body_;
  BodySearch own_, other_;
};

/// Whether names alone tell how the body stands.
bool TellTheBody(const std::vector<NamedPlace>& named, std::ptrdiff_t markers) {
  const auto placed = std::count_if(named.begin(), named.end(),
                                    [](const NamedPlace& one) { return one.is_at_place; });
  return placed >= NamedTuning::kFewest &&
         static_cast<double>(placed) >= NamedTuning::kFewestOfAll * static_cast<double>(markers);
}

void IterateFromStart(LearnedPlaces* learned) {
  for (const double independent : LearnTuning::kIndependent) {
    learned->Iterate(LearnTuning::kTurnsOfEach, independent);
  }
}

/// The best of several starts, and by label how far the others agree with it, as they are good.
class Starts {
 public:
  void Add(std::unique_ptr<LearnedPlaces> learned) {
    IterateFromStart(learned.get());
    costs_.push_back(learned->cost());
    sites_.push_back(learned->SitesOfLabels());
    if (!best_ || learned->cost() < best_->cost()) best_ = std::move(learned);
  }

  const LearnedPlaces* best() const { return best_.get(); }
  std::unique_ptr<LearnedPlaces> TakeBest() { return std::move(best_); }

  /// The share of the starts that have a label on a site; the worse a start, the less it counts.
  double Agreement(int label, int site) const {
    const double least = *std::min_element(costs_.begin(), costs_.end());
    double same = 0, all = 0;
    for (std::size_t i = 0; i < costs_.size(); ++i) {
      const double weight = std::exp((least - costs_[i]) / LearnTuning::kWorseStart);
      all += weight;
      if (sites_[i][static_cast<std::size_t>(label)] == site) same += weight;
    }
    return same / all;
  }

 private:
  std::vector<double> costs_;
  std::vector<std::vector<int>> sites_;
  std::unique_ptr<LearnedPlaces> best_;
};

/// From the body as it is found in several frames, and the best of these mirrored.
void StartFromSearches(const LearnedPlaces& blank, const BodySites& sites,
                       const std::function<void(int, int)>& progress, Starts* starts) {
  // Beyond that distance after so many starts there is nobody [m]; persons' are 0.002 to 0.03, even
  // where the height is wrong or limbs are taken for others.
  constexpr int kTriedForNobody = 2;
  constexpr double kNobody = 0.05;
  AnyBodySearch search(sites);
  const std::vector<LearnFrame>& frames = blank.frames();
  int tried = 0;
  for (int i = 0; i < LearnTuning::kSearched; ++i) {
    const auto k = static_cast<int>((2 * i + 1) * frames.size() / (2 * LearnTuning::kSearched));
    const Matrix3Xd points = SeenPoints(frames[k]);
    if (points.cols() < BodyLimits::kFewestMarkers) continue;
    auto learned = std::make_unique<LearnedPlaces>(blank);
    learned->Start(k, search.Find(points));
    starts->Add(std::move(learned));
    if (++tried == kTriedForNobody && starts->best()->mean_distance() > kNobody) {
      throw Error(fmt::format(
          "the labels move as no body does: in the best postures they are {:.0f} mm from where one "
          "wears them, a person's at most {:.0f}; are height and unit right, and is it one person?",
          kMillimetres * starts->best()->mean_distance(), kMillimetres * kNobody));
    }
    if (progress) progress(i + 1, LearnTuning::kSearched + 1);
  }
  if (starts->best() == nullptr) {
    throw Error(fmt::format("no frame shows {} labels, so that nobody is found",
                            BodyLimits::kFewestMarkers));
  }
  std::vector<WornPlace> mirrored = starts->best()->places();
  for (WornPlace& worn : mirrored) {
    if (worn.site >= 0) std::tie(worn.site, worn.p_SM) = sites.Mirrored(worn.site, worn.p_SM);
  }
  auto learned = std::make_unique<LearnedPlaces>(blank);
  learned->Start(mirrored);
  starts->Add(std::move(learned));
}

void StartFromNames(const LearnedPlaces& blank, const std::vector<NamedPlace>& named,
                    Starts* starts) {
  std::vector<WornPlace> places(named.size());
  for (std::size_t l = 0; l < named.size(); ++l) {
    if (named[l].is_at_place) places[l] = {named[l].site, named[l].p_SM, named[l].deviation, 0};
  }
  auto learned = std::make_unique<LearnedPlaces>(blank);
  learned->Start(places);
  starts->Add(std::move(learned));
}

/// Moves labels to sites nearby as long as that is better, and tells how much worse the next best
/// site of each is.
class Mover {
 public:
  Mover(const BodySites& sites, const MatrixXd& deviations, std::unique_ptr<LearnedPlaces> learned)
      : sites_(sites), deviations_(deviations), learned_(std::move(learned)) {}

  void Run() {
    for (int round = 0; round < LearnTuning::kRounds && TryAll(); ++round) {
      learned_->Iterate(1, LearnTuning::kIndependent.back());
      learned_->AllowForSkinAtJoints();
    }
  }

  const LearnedPlaces& learned() const { return *learned_; }
  /// By label.
  const std::vector<double>& leads() const { return leads_; }

 private:
  bool TryAll() {
    leads_.assign(learned_->places().size(), LearnTuning::kMostLead);
    Stay();
    bool is_better = false;
    for (const std::vector<int>& group : RigidGroups(learned_->SitesOfLabels(), deviations_)) {
      if (group.size() > 1) is_better |= TryGroup(group);
    }
    for (int l = 0; l < static_cast<int>(leads_.size()); ++l) {
      if (learned_->places()[l].site >= 0) is_better |= TryGroup({l});
    }
    return is_better;
  }

  void Stay() {
    stays_ = learned_->Moved({}, -1, LearnTuning::kTurns)->cost();
    group_stays_ = learned_->Moved({}, -1, LearnTuning::kTurnsOfGroups)->cost();
  }

  bool TryGroup(const std::vector<int>& group) {
    const int site = learned_->places()[group.front()].site;
    for (const int other : sites_.Neighbours(site)) {
      double more = 0;
      for (const int l : group) more += learned_->costs()(l, other) - learned_->costs()(l, site);
      if (more > LearnTuning::kHopeless * static_cast<double>(group.size())) continue;
      const bool is_single = group.size() == 1;
      auto moved = learned_->Moved(group, other,
                                   is_single ? LearnTuning::kTurns : LearnTuning::kTurnsOfGroups);
      const double lead = moved->cost() - (is_single ? stays_ : group_stays_);
      for (const int l : group) leads_[l] = std::min(leads_[l], lead);
      if (lead > -LearnTuning::kLeastGain) continue;
      learned_ = std::move(moved);
      Stay();
      return true;
    }
    return false;
  }

  const BodySites& sites_;
  const MatrixXd& deviations_;
  std::unique_ptr<LearnedPlaces> learned_;
  std::vector<double> leads_;
  double stays_ = 0, group_stays_ = 0;  // what it costs if nothing moves
};

/// Makes points that are no markers unseen.
void LeaveOut(const std::vector<std::string>& reasons, std::vector<LearnFrame>* frames) {
  for (std::size_t l = 0; l < reasons.size(); ++l) {
    if (reasons[l].empty()) continue;
    for (LearnFrame& frame : *frames) frame.z.col(static_cast<Eigen::Index>(l)).setConstant(kNaN);
  }
}

/// Of the frames that show most the one that is nearest to all angles 0.
void ShowOneFrame(const LearnedPlaces& learned, LearnedMarkers* result) {
  double best = -1;
  for (const LearnFrame& frame : learned.frames()) {
    if (frame.posture.joint_angles.size() == 0) continue;
    const auto seen = static_cast<double>(frame.z.row(0).array().isFinite().count());
    const double score = seen / (1 + LearnTuning::kAngleWeight * frame.posture.joint_angles.norm());
    if (score <= best) continue;
    best = score;
    result->posture = frame.posture;
    result->points = frame.z;
  }
}

/// The probability of the site of a label, if the body stands as it was found. lead: how much less
/// that costs than the next best site.
double SurenessOf(const WornPlace& worn, double lead) {
  const double excess = std::max(0.0, worn.scatter - SurenessTuning::kUsualScatter);
  return 1 / (1 + std::exp(-SurenessTuning::kOffset - lead / SurenessTuning::kLead +
                           excess / SurenessTuning::kScatter));
}

/// The share of a body's sites that wear labels.
double WornShare(const std::vector<int>& sites_of_labels, std::size_t sites) {
  std::set<int> worn(sites_of_labels.begin(), sites_of_labels.end());
  worn.erase(-1);
  return static_cast<double>(worn.size()) / static_cast<double>(sites);
}

/// What is known before places are learnt.
struct Known {
  std::vector<std::string> labels;
  std::vector<std::string> computed;  ///< WhyNoMarkers
  std::vector<NamedPlace> named;
  MatrixXd deviations;
};

void CheckAreEnough(const std::vector<std::string>& computed) {
  const auto count = std::count(computed.begin(), computed.end(), "");
  if (count < BodyLimits::kFewestMarkers) {
    throw Error(fmt::format("{} markers are too few to find a body; at least {} are needed", count,
                            BodyLimits::kFewestMarkers));
  }
}

LearnedMarkers LearnOnFrames(const Known& known, const BodySites& sites,
                             std::vector<LearnFrame> frames,
                             const std::function<void(int, int)>& progress) {
  LearnedMarkers result;
  result.frames = static_cast<int>(frames.size());
  const LearnedPlaces blank(sites, std::move(frames), known.deviations, known.named);
  Starts starts;
  const auto markers = std::count(known.computed.begin(), known.computed.end(), "");
  const bool are_named = TellTheBody(known.named, markers);
  if (are_named) {
    StartFromNames(blank, known.named, &starts);
  } else {
    StartFromSearches(blank, sites, progress, &starts);
  }
  auto best = starts.TakeBest();
  best->Iterate(LearnTuning::kTurnsAtLast, LearnTuning::kIndependent.back());
  best->AllowForSkinAtJoints();
  Mover mover(sites, known.deviations, std::move(best));
  mover.Run();
  const LearnedPlaces& learned = mover.learned();
  double whole = 1;  // the probability that the body stands as it was found
  if (!are_named &&
      WornShare(learned.SitesOfLabels(), sites.sites().size()) < SurenessTuning::kWholeBody) {
    whole = SurenessTuning::kPartOfBody;
    result.warnings.emplace_back(
        "labels are worn on a part of a body, and no names tell on which: legs look like arms; "
        "give them usual names, or more of the body");
  }
  result.mean_distance = learned.mean_distance();
  for (std::size_t l = 0; l < known.labels.size(); ++l) {
    const WornPlace& worn = learned.places()[l];
    LearnedMarker& marker = result.markers.emplace_back();
    marker.label = known.labels[l];
    marker.left_out = known.computed[l];
    if (worn.site < 0) {
      if (marker.left_out.empty()) marker.left_out = "hardly seen";
      continue;
    }
    const auto [node, p_SM] = sites.OnUsualNode(worn.site, worn.p_SM);
    marker.segment = sites.model().segments()[node].name;
    marker.p_SM = p_SM;
    marker.scatter = worn.scatter;
    marker.probability = SurenessOf(worn, std::min(mover.leads()[l], worn.lead)) *
                         starts.Agreement(static_cast<int>(l), worn.site) * whole;
  }
  LeaveOutDoubtful({sites, learned, known.deviations, known.labels, known.named}, &result);
  ShowOneFrame(learned, &result);
  return result;
}

}  // namespace

LearnedMarkers LearnMarkers(const Wearer& wearer,
                            const std::vector<const MarkerSequence*>& recordings,
                            const std::function<void(int, int)>& progress) {
  const CommonLabels labels = FindCommonLabels(recordings);
  if (labels.names.size() > BodyLimits::kMostLabels) {
    throw Error(fmt::format("{} labels are too many to learn a marker set of; at most {}",
                            labels.names.size(), BodyLimits::kMostLabels));
  }
  std::vector<LearnFrame> frames = ChooseLearnFrames(recordings, labels);
  const std::vector<std::string> computed = WhyNoMarkers(labels.names, frames);
  LeaveOut(computed, &frames);
  CheckAreEnough(computed);
  const KinematicModel model = wearer.scale(wearer.reference);
  const BodySites sites(model, wearer.joints);
  NamedPlaces named =
      FindNamedPlaces(labels.names, recordings, {wearer.reference, sites, wearer.scale});
  const MatrixXd deviations = DistanceDeviations(frames);
  LearnedMarkers result =
      LearnOnFrames({labels.names, computed, std::move(named.labels), deviations}, sites,
                    std::move(frames), progress);
  result.warnings.insert(result.warnings.begin(), named.warnings.begin(), named.warnings.end());
  if (progress) progress(LearnTuning::kSearched + 1, LearnTuning::kSearched + 1);
  return result;
}

}  // namespace mmm_converter
