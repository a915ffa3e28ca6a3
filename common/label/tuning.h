// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace mmm_converter {

// Every number of this room that was chosen and not derived, with its unit and what it is for.
// Costs have no unit: a squared distance in standard deviations. Before each part stand the tests
// that look at it; a change also needs the rows of label_benchmark, with seeds that were not looked
// at before (tests/benchmark/RESULTS.md, Labels).

/// Bodies that can be named at all.
// Tests: LabelRecordingTest.TooManyPointsAreAnError, SceneStartTest, LearnMarkersTest.
struct BodyLimits {
  static constexpr int kFewestMarkers = 10;  ///< of a body, and points to look for one among
  static constexpr int kMostPoints = 1000;   ///< of a frame: time grows with their square
  static constexpr int kMostLabels = 1000;   ///< that a set is learnt of, for the same reason
};

/// How far from the model's place a marker may be worn, and slide (LabelBody).
// Tests: LabelBodyTest.
struct PlaceTuning {
  static constexpr double kByHeight = 0.03;  ///< [m] of one with noise scale 1, not calibrated
  static constexpr double kMost = 0.06;      ///< [m]: beyond, a neighbour is as likely
  static constexpr double kLeast = 0.008;    ///< [m] calibrated: skin moves between sessions
  /// Of a calibrated deviation. Most of that is common to the markers of a link, and the posture
  /// makes up for it.
  static constexpr double kOwnShare = 0.4;
  static constexpr double kSkin = 0.006;       ///< [m] about its own place, not calibrated
  static constexpr double kLeastSkin = 0.005;  ///< [m] calibrated: what the posture leaves
};

/// What a posture with points costs (BodyMatch).
// Tests: PointFitTest, LimbSearchTest.
struct MatchCosts {
  static constexpr double kUnmatched = 9;        ///< of a marker without point: three deviations
  static constexpr double kSettled = 0.015;      ///< [m] what a posture may still be off
  static constexpr double kNaturalWeight = 0.3;  ///< [1/rad^2] from the natural angles
  static constexpr double kGood = 3;  ///< of a marker with its point: a coordinate costs 1
};

/// A step of a posture towards targets (StepTowards, LimbSearch).
// Tests: PostureStepTest.
struct StepTuning {
  static constexpr double kDamping = 0.01;          ///< of the diagonal (Levenberg-Marquardt)
  static constexpr double kLeastCurvature = 1e-3;   ///< [1/m^2], [1/rad^2] where nothing is seen
  static constexpr double kLongest = 0.6;           ///< [rad]: beyond, nothing is linear
  static constexpr int kSolves = 3;                 ///< until no joint steps over its limit
  static constexpr double kNoRobustDistance = 1e9;  ///< [m]: every target counts in full
};

/// Shares of points for markers (SoftAssignment).
// Tests: SoftAssignmentTest.
struct SoftTuning {
  static constexpr int kRounds = 4;                       ///< of Sinkhorn's balancing
  static constexpr double kSlack = 0.011108996538242306;  ///< exp(-9/2): three deviations off
  static constexpr double kLeastExponent = -14;  ///< of a share: a ten-thousandth of the slack
  static constexpr double kLeastWeight = 1e-3;   ///< of a marker that has a target at all
};

/// Steps of soft assignment while the spread of the markers shrinks.
struct Annealing {
  double from, to;  ///< spread [m]
  int steps;
};

/// A fit to points without names (PointFit).
// Tests: PointFitTest.
struct FitTuning {
  static constexpr double kLeastGain = 0.1;     ///< of a turn of assignment and step that goes on
  static constexpr int kMostTurns = 6;          ///< of a whole body
  static constexpr double kLeastWeight = 1e-9;  ///< of a marker's shares: no division by zero
};

/// The body in one frame, from nothing (BodySearch).
// Tests: BodySearchTest; label_benchmark starts, starts-hard.
struct SearchTuning {
  static constexpr int kYaws = 24;  ///< turns about the vertical: 15 degrees apart
  /// Distances from the nearest point, on a grid about the person and their reach.
  static constexpr double kCell = 0.04;      ///< [m]
  static constexpr double kFarthest = 0.2;   ///< [m]: cut off, so that a missing point costs little
  static constexpr int kCells = 96;          ///< in each direction
  static constexpr double kReach = 1.5;      ///< [m] of a person from the middle of the points
  static constexpr double kMostCells = 1e6;  ///< from the origin: no farther off than an int says
  /// Postures that are annealed at a time; others only where the best of these are not good.
  static constexpr std::size_t kAnnealed = 128;
  static constexpr std::size_t kMostAnnealed = 256;
  /// Postures that go on after each stage.
  struct Stage {
    Annealing annealing;
    std::size_t kept;
  };
  static constexpr std::array<Stage, 3> kStages = {
      {{{0.20, 0.12, 5}, 40}, {{0.12, 0.07, 5}, 20}, {{0.07, 0.03, 6}, 20}}};
  /// Of the last postures, that are settled in any case; the others where these are not good.
  static constexpr std::size_t kSettledFirst = 4;
  /// Of the cost that no match at all would have. Where markers are hidden, ghosts hide how many.
  static constexpr double kGoodShare = 0.1, kGoodShareHidden = 0.15;
  /// A posture that is about right: from how far off is for the caller to say.
  static constexpr double kNearTo = 0.03;  ///< [m]
  static constexpr int kNearSteps = 10;
};

/// Limbs at random angles (LimbSearch, and with the whole body BodySearch).
// Tests: LimbSearchTest, RandomizeJointsTest; label_benchmark starts-hard.
struct LimbTuning {
  /// Tries: for each posture of the last stage, for the best of these, and for that as long as it
  /// is not good.
  struct Tries {
    int first, once, more;
  };
  static constexpr Tries kTriesAlone = {40, 100, 300};
  static constexpr Tries kTriesWithBody = {0, 40, 120};
  static constexpr Annealing kAnnealing = {0.12, 0.03, 8};
  static constexpr double kNearby = 0.5;          ///< [rad] deviation of angles that stay nearby
  static constexpr double kNearbyShare = 0.5;     ///< of the tries
  static constexpr double kAllJointsShare = 0.5;  ///< of the tries; else the second half
  static constexpr double kReach = 0.5;      ///< [m]: a free point farther off is not a marker's
  static constexpr double kBeside = 0.25;    ///< [m] of limbs that may have each other's points
  static constexpr double kPairShare = 0.4;  ///< of the tries, where limbs are beside each other
  static constexpr double kTwoPointsShare = 0.8;  ///< that put two markers at two points
  static constexpr double kAnyShare = 0.5;        ///< of any limb, however well it matches
  static constexpr double kHeldShare = 0.5;  ///< of those with two points: what is inside is held
  static constexpr int kTwoPointsSteps = 6;
  static constexpr double kAsFar = 0.02;   ///< [m] by which two distances are the same
  static constexpr double kLeastGain = 1;  ///< of a try that is kept
  static constexpr int kMostTurns = 4;     ///< of assignment and step
};

/// Several bodies in one frame (FindScene).
// Tests: SceneStartTest.
struct SceneTuning {
  static constexpr int kFrames = 8;        ///< that bodies are looked for in
  static constexpr int kMedianTurns = 20;  ///< of k-medians
  static constexpr int kFullestShare = 3;  ///< one of so many frames is full enough
  static constexpr double kBadCost = 2;    ///< of a marker: perhaps the size is wrong
  static constexpr double kLeastScale = 0.55, kMostScale = 1.9, kScaleStep = 1.08;
  static constexpr double kOtherSize = 0.15;    ///< of the height: it is wrong, not inexact
  static constexpr double kClearlyFewer = 0.6;  ///< of the cost at the height that was given
};

/// Rigid objects (RigidFinder, FindObjectTracks).
// Tests: RigidFinder, ObjectTracksTest; label_benchmark together.
struct ObjectTuning {
  static constexpr int kMostPoints = 300;          ///< of a frame: time grows with their square
  static constexpr double kInPlace = 0.01;         ///< [m] of a point from its marker's place
  static constexpr double kOffLine = 0.01;         ///< [m]: three on a line tell no pose
  static constexpr double kAsExpected = 0.03;      ///< [m] from where it should be after a frame
  static constexpr double kAsBefore = 0.06;        ///< [m] where it is not known how it moves
  static constexpr int kFewest = 3;                ///< markers that tell a pose
  static constexpr int kFewestAnywhere = 4;        ///< or all: three points are alike by chance
  static constexpr long kMostChecks = 4'000'000;   ///< of points, then a search is given up
  static constexpr long kChecksOfATry = 1000;      ///< that a try of three points counts as
  static constexpr std::size_t kMostTriples = 60;  ///< of markers that are tried, the widest first
  static constexpr double kTrackShare = 0.5;       ///< of a track's frames that make it an object's
  static constexpr int kSearchEvery = 5;           ///< frames, of an object that is not there
};

/// Which points follow each other (PointFollower).
// Tests: PointTracksTest.
struct FollowTuning {
  static constexpr double kAcceleration = 80;  ///< [m/s^2] of a quick hand or foot
  static constexpr double kNearby = 0.006;     ///< [m] of slack: noise, and skin
  static constexpr double kFarthest = 0.12;    ///< [m], however long the frame
  static constexpr double kClearly = 3;        ///< times nearer than the next, beyond the slack
};

/// How a body is expected to move (LabelBelief).
// Tests: LabelBeliefTest; label_benchmark online-hard.
struct MovementTuning {
  struct Kind {
    double speed;  ///< standard deviation where nothing is known [m/s], [rad/s]
    double start;  ///< deviation of a body that was found [m], [rad]
  };
  static constexpr Kind kRoot = {1, 0.02}, kTurn = {2, 0.05}, kJoint = {3, 0.1};
  static constexpr double kVelocityMemory = 0.25;  ///< [s] for which a velocity lasts
  static constexpr double kSpeedMemory = 0.3;      ///< [s] in which past speed is forgotten
  static constexpr double kFaster = 2;             ///< times as fast as a dof was, as a deviation
  static constexpr double kSlowest = 0.05;         ///< of the speed where nothing is known
};

/// Frame by frame (LabelTracker).
// Tests: LabelTrackerTest; label_benchmark online-hard.
struct TrackTuning {
  static constexpr double kUnassigned = 21.1;       ///< chi-square of three: once in 10,000
  static constexpr double kGate = 2 * kUnassigned;  ///< beyond, a pair is not thought of
  static constexpr double kFarthestPlace = 12;  ///< most that the way from the model's place costs
  static constexpr double kVague = 0.012;       ///< [m] of expected places: annealed beyond
  static constexpr int kVaguePercent = 90;      ///< of the markers that are better known
  static constexpr Annealing kAnnealing = {0.2, 0.02, 6};  ///< from less where less is vague
  static constexpr double kUnknown = 0.05;       ///< [m]: beyond, one point does not take up a limb
  static constexpr double kOnlyChoice = 9;       ///< by which a point is better than any other
  static constexpr int kTurns = 3;               ///< of assignment and update
  static constexpr double kLinear = 0.02;        ///< [m]: a step so short is as good as linear
  static constexpr double kContinued = 0.15;     ///< [m] from where it should be: skin in a throw
  static constexpr double kOffsetMemory = 1;     ///< [s] in which a hidden marker's is forgotten
  static constexpr double kOffsetDrift = 0.004;  ///< [m / sqrt(s)] of a seen one
  static constexpr double kNearby = 0.06;        ///< [m] that another posture is looked for within
  static constexpr int kLimbTries = 20;          ///< of that look
};

/// What points are nobody's (FreePoints).
// Tests: FreePointsTest.
struct FreePointTuning {
  static constexpr double kUsual = 5;        ///< [points] of a frame, before any was seen
  static constexpr double kMemory = 0.5;     ///< [s] of the mean
  static constexpr double kRarest = 0.2;     ///< [points]: what half a second can't tell from none
  static constexpr double kMostSurplus = 6;  ///< that a marker without point costs more
};

/// When a body that is followed is looked for again, and what takes its place (BodyWatch).
struct WatchPolicy {
  double fitting = 0;           ///< share of what could fit that has to
  int fewest_points = 0;        ///< so many could fit, if fewer are seen
  bool counts_absence = false;  ///< where less than half of the markers have points, too
  double patience = std::numeric_limits<double>::infinity();  ///< [s] without: it is lost
  double every = std::numeric_limits<double>::infinity();  ///< [s]: another posture is looked for
  double gain = 0;      ///< of cost by which that has to be better
  int other_names = 0;  ///< that it has to give
  int running = 1;      ///< looks that have to say so
};
// Tests: LabelledPersonTest, LabelRecordingTest.WhoLeavesAndReturnsIsFoundAgain, LiveLabellerTest.
struct WatchTuning {
  /// Nearby. The gain is a little less than a marker without point costs: a lone one says as much.
  static constexpr WatchPolicy kNearby = {.every = 0.1, .gain = 8.5};
  /// Anywhere, in a recording: who was away for a while may be elsewhere.
  static constexpr WatchPolicy kRecorded = {.fitting = 0.75, .patience = 0.5, .gain = 10};
  /// Of a stream, which is forgotten where half does not fit: what follows would be wrong.
  static constexpr WatchPolicy kLive = {.fitting = 0.5,
                                        .fewest_points = BodyLimits::kFewestMarkers,
                                        .counts_absence = true,
                                        .patience = 0.5,
                                        .every = 1};
  /// Anywhere, of a stream that seems to fit. A wrong change would be seen: two looks have to
  /// agree.
  static constexpr WatchPolicy kLiveAnywhere = {.gain = 20, .other_names = 3, .running = 2};
};

/// A recording (LabelRecording, LabelledPerson).
// Tests: LabelRecordingTest, LabelledPersonTest; label_benchmark offline-hard.
struct RecordingTuning {
  static constexpr double kLeastShare = 0.25;  ///< of the votes that gives a name
  static constexpr double kSureName = 0.7;     ///< of the votes: a name that is sure
  static constexpr double kVote = 0.25;        ///< of a way; of both together twice that
  static constexpr double kHint = 6;           ///< cost that a sure name of the last time is worth
  static constexpr int kStartsTried = 3;       ///< where somebody is not calibrated
  static constexpr int kMostVainSearches = 4;  ///< for a person: who is there is found
  static constexpr int kMostFramesTried = 3000;  ///< of longer recordings one start is tried
  static constexpr int kPart = 256;              ///< frames whose predictions are kept: memory
  static constexpr double kKnown = 0.02;     ///< [m] of a link that tells where a marker is worn
  static constexpr double kKeptEvery = 0.1;  ///< [s]: skin has moved on
  static constexpr int kMostKept = 40;       ///< frames that names are tried on
};

/// Markers far from their places (WornElsewhere).
// Tests: WornElsewhereTest.
struct ElsewhereTuning {
  static constexpr double kReach = 0.2;             ///< [m] by height alone, as shin markers may be
  static constexpr double kReachCalibrated = 0.08;  ///< [m] put on anew since
  static constexpr double kShare = 0.9;             ///< of the votes, as what is found so counts
  static constexpr int kLeastFrames = 10;         ///< of a track; of shorter ones nothing is known
  static constexpr double kLeastTime = 1;         ///< [s] of all tracks at a place
  static constexpr double kScatter = 0.015;       ///< [m] of a track about its place, a coordinate
  static constexpr double kShareOfPath = 0.2;     ///< of how far the points move with the link
  static constexpr double kSamePlace = 0.03;      ///< [m]
  static constexpr std::size_t kMostPlaces = 50;  ///< of a marker's longest tracks
};

/// Names tried the other way round (ExchangedNames).
// Tests: ExchangedNamesTest.
struct ExchangeTuning {
  static constexpr double kModelScatter = 0.008;   ///< [m] of a place, besides skin
  static constexpr double kFarthest = 25;          ///< cost of a marker in a frame, at most
  static constexpr double kNearEachOther = 0.12;   ///< [m] of two that may be exchanged
  static constexpr double kLeastGain = 2;          ///< of cost, in all frames together
  static constexpr std::size_t kFewestFrames = 2;  ///< to be tried on
  static constexpr int kSteps = 2;                 ///< of each frame, a turn
  static constexpr double kRobustDistance = 0.05;  ///< [m]: beyond, a marker only pulls
  static constexpr int kTurns = 8;                 ///< of postures and places, for all frames
  static constexpr int kTurnsOfATrial = 4;
  static constexpr double kHopeless = 30;  ///< more cost: a trial is given up
  static constexpr int kMostPasses = 3;    ///< over all pairs
};

/// The frames that a marker set is learnt on (ChooseLearnFrames).
// Tests: LearnFramesTest.
struct LearnFrameTuning {
  static constexpr int kFrames = 60;         ///< time grows with their number
  static constexpr std::size_t kFewest = 5;  ///< in which two labels are seen together
  static constexpr double kUnknown = 1e9;    ///< [m] a deviation that is not known
  static constexpr double kRigid = 0.006;    ///< [m] a distance that is kept: skin on one part
};

/// Where labels are worn (LearnedPlaces).
// Tests: LearnedPlacesTest, LearnMarkersTest.
struct LearnPlaceTuning {
  static constexpr double kSkin = 0.008;          ///< [m] each coordinate
  static constexpr double kSkinAtJoints = 0.017;  ///< [m] more, over which it slides
  static constexpr double kReachOfJoints = 0.06;  ///< [m] deviation of the distance from them
  static constexpr double kBeyond = 0.012;        ///< [m] outside of where a site has its markers
  static constexpr double kMostOfBeyond = 60;
  static constexpr double kNear = 0.03;  ///< [m] of the model's own markers
  static constexpr double kMostOfNear = 9;
  static constexpr double kLeastRadius = 0.04, kMargin = 0.025;  ///< [m] of a site about its bones
  static constexpr double kUnlikeOtherSide = 4;                  ///< where the other side has fewer
  static constexpr double kRigidWeight = 4;                      ///< of distances that are not kept
  static constexpr double kRigidUsual = 0.004;  ///< [m] deviation of those that are
  static constexpr double kRigidMost = 0.1;     ///< [m] beyond, all are alike
  static constexpr double kWeight = 1.5;        ///< of a frame's three coordinates
  static constexpr double kStays = 0.5;         ///< cost that a label's site of the last turn saves
  static constexpr double kTrimmed = 0.9;     ///< of the frames, the nearest ones: others are wrong
  static constexpr int kFewestSeen = 5;       ///< frames of a label that has a place
  static constexpr double kImpossible = 1e6;  ///< cost of a site that is not tried
};

/// What names count (FindNamedPlaces, LearnedPlaces).
// Tests: NamedPlacesTest, LearnMarkersTest.
struct NamedTuning {
  static constexpr int kFewest = 6;                  ///< labels that are understood
  static constexpr double kMostContradicted = 0.34;  ///< of these, else no name is believed
  static constexpr double kFewestOfAll = 0.25;       ///< of the labels, that tell the body alone
  static constexpr double kDeviation = 0.028;        ///< [m] of each axis, at noise scale 1
  static constexpr double kReachOfJoints = 0.07;     ///< [m]: across a joint is as good as on it
  static constexpr double kNextToNamed = 4;          ///< cost there
  static constexpr double kElsewhere = 12;           ///< cost anywhere else
};

/// The postures of these (LearnedPlaces).
// Tests: LearnedPlacesTest, LearnMarkersTest.
struct LearnFitTuning {
  static constexpr double kRobustDistance = 0.04;  ///< [m]: beyond, a label only pulls
  static constexpr double kNoiseUnit = 0.01;       ///< [m] of noise scale 1
  static constexpr int kFewestLabels = 10;         ///< of a frame that has a posture
  static constexpr double kBadStart = 0.04;        ///< [m] mean distance: limbs are tried elsewhere
  static constexpr double kBad = 0.03;             ///< [m] later
  static constexpr int kTriesAtStart = 6, kTries = 4, kTriesFromNothing = 20;
};

/// The search among starts and sites (LearnMarkers).
// Tests: LearnMarkersTest.
struct LearnTuning {
  static constexpr int kSearched = 8;         ///< frames that the body is looked for in
  static constexpr double kAnyPlace = 0.045;  ///< [m] of others' markers from the model's
  static constexpr double kOwnCost = 1;       ///< of a marker, where the set is the model's own
  /// Frames that count each for itself: few at first, so that what is usual counts.
  static constexpr std::array<double, 3> kIndependent = {2, 5, 15};
  static constexpr int kTurnsOfEach = 2, kTurnsAtLast = 20;
  static constexpr int kRounds = 3;                     ///< over all labels
  static constexpr int kTurns = 3, kTurnsOfGroups = 8;  ///< of a move
  static constexpr double kLeastGain = 0.5;             ///< of a move
  static constexpr double kHopeless = 60;               ///< more cost of a label: not tried
  static constexpr double kMostLead = 60;               ///< exp(-60) of doubt is none
  static constexpr double kWorseStart = 80;             ///< cost by which one counts less, 1/e
  static constexpr double kAngleWeight = 0.05;          ///< [1/rad] of the frame that is shown
};

/// How sure a site is: a logistic curve, fitted to made persons of two seeds.
// Tests: LearnMarkersTest.
struct SurenessTuning {
  static constexpr double kOffset = -1;
  static constexpr double kLead = 1;              ///< cost that is one in the log of the odds
  static constexpr double kUsualScatter = 0.012;  ///< [m]
  static constexpr double kScatter = 0.005;       ///< [m] beyond, the same
  static constexpr double kWholeBody = 0.6;       ///< of the sites; fewer are a part of one
  static constexpr double kPartOfBody = 0.25;     ///< that one without names is the one it seems
};

/// What is left out (LeaveOutDoubtful).
// Tests: LearnedPlacesTest, LearnMarkersTest.
struct DoubtTuning {
  static constexpr double kSure = 0.9;          ///< probability of a site that is believed
  static constexpr double kClearly = 1;         ///< of cost, by which another place is likelier
  static constexpr double kFarBetter = 3;       ///< times as well, that distances are kept
  static constexpr double kRigidly = 0.004;     ///< [m] deviation of a distance that is kept
  static constexpr double kOutside = 0.03;      ///< [m] of a site: too far
  static constexpr double kLongestWand = 0.15;  ///< [m] the same, of what keeps its distances
  static constexpr double kMostScatter = 0.04;  ///< [m] about a place, each coordinate
};

/// Points that are no markers (WhyNoMarkers).
// Tests: ComputedPointsTest.
struct ComputedTuning {
  static constexpr int kFewestCompared = 10;    ///< frames
  static constexpr double kExactly = 1e-4;      ///< [m], rounding in files included
  static constexpr double kShareOfSkin = 0.03;  ///< of how far its sources vary
  static constexpr double kLeastSkin = 1e-6;    ///< [m]: markers that were made are rigid
  static constexpr std::size_t kNearest = 8;    ///< labels that it can be computed from
  static constexpr double kAtAnEnd = 0.02;      ///< of the way between two: it is one of them
  static constexpr double kStill = 5e-5;        ///< [m] radius of what stands still
  static constexpr double kMoving = 0.02;       ///< [m] median radius of what moves
  static constexpr double kFarAway = 3;         ///< [m] from the others
};

}  // namespace mmm_converter
