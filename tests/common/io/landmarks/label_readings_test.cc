// SPDX-License-Identifier: MIT
#include "common/io/landmarks/label_readings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const LandmarkTable& Table() {
  static const LandmarkTable table(testing::SourcePath("xml_config/landmarks.xml"));
  return table;
}

std::string Describe(const LabelReading& reading) {
  const char* const sides[] = {"", "left ", "right "};
  return sides[static_cast<int>(reading.side)] +
         Table().landmarks()[static_cast<std::size_t>(reading.landmark)].name;
}

/// What each label means among the others; "-": it is left out.
std::vector<std::string> Meanings(const std::vector<std::string>& labels) {
  std::vector<std::string> meanings;
  for (const ReadLabel& one : ReadLabels(labels, {}, Table())) {
    const bool is_out = one.readings.empty() || !one.why_left_out.empty();
    meanings.push_back(is_out ? "-" : Describe(one.readings.front()));
  }
  return meanings;
}

TEST(LabelReadings, SidesAreInAnySpelling) {
  for (const char* label :
       {"LASI", "L.ASIS", "l_asis", "Left ASIS", "ASIS_L", "asis left", "gauche_asis", "LxAsis",
        "WaistLFront", "Anna:LASI", "L_IAS", "pLeftASI", "SIAS_links", "L.ASIS_study"}) {
    EXPECT_THAT(Meanings({label}), ElementsAre("left anterior iliac spine")) << label;
  }
  for (const char* label : {"RKNE", "r.Knee_Lat", "Knee lat right", "R_FLE", "genou_droit", "RLFC",
                            "RKneeOut", "pRightKneeLatEpicondyle", "rechts Knie"}) {
    EXPECT_THAT(Meanings({label}), ElementsAre("right lateral epicondyle of the femur")) << label;
  }
}

// A letter at the end is a side where the other side is there, too.
TEST(LabelReadings, LettersAtTheEndNeedTheOtherSide) {
  EXPECT_THAT(Meanings({"HeelL", "HeelR"}), ElementsAre("left heel", "right heel"));
  EXPECT_THAT(Meanings({"heel_g", "heel_d"}), ElementsAre("left heel", "right heel"));
  EXPECT_THAT(Meanings({"heel_g"}), ElementsAre("-"));
  EXPECT_THAT(Meanings({"MLG", "MLD", "EASG", "EASD"}),
              ElementsAre("left lateral malleolus", "right lateral malleolus",
                          "left anterior iliac spine", "right anterior iliac spine"));
  EXPECT_THAT(Meanings({"EASG"}), ElementsAre("-"));
  EXPECT_THAT(Meanings({"FRTHI", "FLTHI"}), ElementsAre("right thigh", "left thigh"));
  EXPECT_THAT(Meanings({"RKNEL"}), ElementsAre("right lateral epicondyle of the femur"));
}

TEST(LabelReadings, MarkersAroundALandmarkAreOfItsSegment) {
  EXPECT_THAT(Meanings({"RSACR", "LSACR", "USACR", "LMUPA", "RDUPA", "LUL", "LRAD"}),
              ElementsAre("right wand on the pelvis", "left wand on the pelvis",
                          "cluster on the pelvis", "left upper arm", "right upper arm",
                          "left ulnar styloid", "left radial styloid"));
}

TEST(LabelReadings, LettersOfNamesAreNoSides) {
  EXPECT_THAT(Meanings({"RAD", "LRAD"})[1], "left radial styloid");
  EXPECT_THAT(
      Meanings({"LLM", "RLM", "LSPH"}),
      ElementsAre("left lateral malleolus", "right lateral malleolus", "left medial malleolus"));
  EXPECT_THAT(Meanings({"L3"}), ElementsAre("third lumbar vertebra"));
  EXPECT_THAT(Meanings({"L3", "R3"}), ElementsAre("-", "-"));
  EXPECT_THAT(Meanings({"LK", "LN", "LQ", "x52", "Marker7", "U12", "*3", ""}),
              ElementsAre("-", "-", "-", "-", "-", "-", "-", "-"));
}

// "LI" is left in German only where the other side is "RE".
TEST(LabelReadings, PairsTellWhichLettersAreTheSide) {
  EXPECT_THAT(
      Meanings({"LIEL", "RIEL", "LIWR", "RIWR"}),
      ElementsAre("left medial epicondyle of the humerus", "right medial epicondyle of the humerus",
                  "left radial styloid", "right radial styloid"));
  EXPECT_THAT(Meanings({"LIELB", "REELB"}), ElementsAre("left lateral epicondyle of the humerus",
                                                        "right lateral epicondyle of the humerus"));
  EXPECT_THAT(Meanings({"LTIC", "RTIC"}), ElementsAre("left shank", "right shank"));
}

TEST(LabelReadings, WordsOfPlaceLeaveTheSegment) {
  EXPECT_THAT(
      Meanings({"L.Thigh.Post.Sup", "R.Shank.Bottom.Lateral", "R_TH_CLUS1", "LeftThighCap"}),
      ElementsAre("left thigh", "right shank", "right thigh", "-"));
}

TEST(LabelReadings, TheSegmentMayBeSaidBesideTheLandmark) {
  EXPECT_THAT(
      Meanings({"pelvis-RASIS", "femur-LEC-r", "tibiafibula-MM-l", "Foot_R_Heel", "Foot_R_Knee"}),
      ElementsAre("right anterior iliac spine", "right lateral epicondyle of the femur",
                  "left medial malleolus", "right heel", "-"));
}

TEST(LabelReadings, WhatAllNamesBeginWithTellsNothing) {
  EXPECT_THAT(Meanings({"w1_Ann_LASI", "w1_Ann_RASI", "w1_Ann_C7", "w1_Ann_RKnee"}),
              ElementsAre("left anterior iliac spine", "right anterior iliac spine",
                          "seventh cervical vertebra", "right lateral epicondyle of the femur"));
  EXPECT_THAT(
      Meanings({"Knee_L_lat", "Knee_L_med", "Knee_R_lat", "Knee_R_med"}),
      ElementsAre("left lateral epicondyle of the femur", "left medial epicondyle of the femur",
                  "right lateral epicondyle of the femur", "right medial epicondyle of the femur"));
}

TEST(LabelReadings, OriginAndAxesOfASegmentAreNoMarkers) {
  EXPECT_THAT(Meanings({"LTIO", "LTIA", "LTIL", "LTIP", "RTIP"}),
              ElementsAre("-", "-", "-", "-", "right shank"));
}

// Epicondyles are those of the limbs that other labels name.
TEST(LabelReadings, LimbsThatNothingNamesAreAbsent) {
  EXPECT_EQ(Meanings({"LLE", "LLM", "LHEE"})[0], "left lateral epicondyle of the femur");
  EXPECT_EQ(Meanings({"LLE", "LRSP", "LUSP"})[0], "left lateral epicondyle of the humerus");
  EXPECT_EQ(Meanings({"LLEP", "LLFC", "LRSP"})[0], "left lateral epicondyle of the humerus");
  const auto both = Meanings({"LLE", "LME", "LELB", "LMEL", "LRSP", "LUSP", "LLM", "LMM"});
  EXPECT_EQ(both[0], "left lateral epicondyle of the femur");
  EXPECT_EQ(both[1], "left medial epicondyle of the femur");
}

// RFTA would be an acromion, RFMC a knee, where no series says that they are of a cluster.
TEST(LabelReadings, SeriesOfLettersAreClusters) {
  EXPECT_THAT(
      Meanings(
          {"RFMA", "RFMB", "RFMC", "RFMD", "LTBA", "LTBB", "LTBC", "RFTA", "RFTB", "RFTC", "LASI"}),
      ElementsAre("right thigh", "right thigh", "right thigh", "right thigh", "left shank",
                  "left shank", "left shank", "right back of the foot", "right back of the foot",
                  "right back of the foot", "left anterior iliac spine"));
  EXPECT_THAT(Meanings({"L_UA_A", "L_UA_B", "L_UA_C"}),
              ElementsAre("left upper arm", "left upper arm", "left upper arm"));
  // Of what is no segment, and of less than three.
  EXPECT_THAT(Meanings({"LXQA", "LXQB", "LXQC", "RWRA", "RWRB"}),
              ElementsAre("-", "-", "-", "right thumb side of the wrist",
                          "right little finger's side of the wrist"));
}

// RTB would be a shank, MET2 and MET5 a foot, onto which a whole leg folds.
TEST(LabelReadings, NoLegComesFromTheLabelsOfAnArm) {
  const std::vector<std::string> arm = {"C7", "T10", "CLAV", "STRN", "RELB", "RWRA", "RWRB"};
  const auto last_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> labels = arm;
    labels.insert(labels.end(), more.begin(), more.end());
    return Meanings(labels).back();
  };
  EXPECT_EQ(last_of({"RTB"}), "-");
  EXPECT_EQ(last_of({"RASI", "LASI", "RTB"}), "-");
  EXPECT_EQ(last_of({"LTB", "RTB"}), "-");
  EXPECT_EQ(last_of({"RKNE"}), "-");
  EXPECT_EQ(last_of({"RASI", "LASI", "RKNE"}), "right lateral epicondyle of the femur");
  EXPECT_EQ(last_of({"RMET2"}), "right knuckle of the index finger");
  EXPECT_EQ(last_of({"RMET2", "RMET5"}), "right knuckle of the little finger");
  EXPECT_EQ(last_of({"RKNE", "RANK", "RMET5"}), "right head of the fifth metatarsal");
  EXPECT_EQ(Meanings({"LASI", "RASI", "SACR", "LKNE", "LANK", "LHEE", "RFRM"})[6], "-");
}

TEST(LabelReadings, TermsOfIsb) {
  const std::vector<std::string> terms = {"IJ", "PX", "C7", "T8", "SC", "AC", "AA", "TS",
                                          "AI", "PC", "EM", "EL", "GH", "US", "RS"};
  std::vector<std::string> small, sided;
  for (const std::string& term : terms) {
    std::string one = term;
    std::transform(one.begin(), one.end(), one.begin(), ::tolower);
    small.push_back(one);
    const bool has_side = term != "IJ" && term != "PX" && term != "C7" && term != "T8";
    sided.push_back(has_side ? "r_" + one : one);
  }
  for (const auto& [labels, side] :
       {std::pair(terms, ""), std::pair(small, ""), std::pair(sided, "right ")}) {
    const auto meanings = Meanings(labels);
    const auto has = [&, of_side = side](std::size_t i, const std::string& what, bool is_sided) {
      EXPECT_EQ(meanings[i], (is_sided ? of_side : "") + what);
    };
    has(0, "notch above the sternum", false);
    has(1, "lower end of the sternum", false);
    has(3, "eighth thoracic vertebra", false);
    has(4, "inner end of the collar bone", true);
    has(5, "acromion", true);
    has(6, "back of the shoulder", true);
    has(7, "inner end of the spine of the shoulder blade", true);
    has(8, "back below the shoulder blade", true);
    has(10, "medial epicondyle of the humerus", true);
    has(11, "lateral epicondyle of the humerus", true);
    has(13, "ulnar styloid", true);
    has(14, "radial styloid", true);
  }
}

TEST(LabelReadings, FrenchNamesHaveAccentsAndSides) {
  EXPECT_THAT(Meanings({"Épaule gauche", "épaule_droite", "Malléole externe gauche",
                        "Malléole interne droite", "Tête", "Genou_externe_G", "Genou_externe_D",
                        "GTalon", "DTalon"}),
              ElementsAre("left acromion", "right acromion", "left lateral malleolus",
                          "right medial malleolus", "head", "left lateral epicondyle of the femur",
                          "right lateral epicondyle of the femur", "left heel", "right heel"));
}

// Of one arm without sides, LARM is no left one.
TEST(LabelReadings, OneArmHasNoSide) {
  const auto read =
      ReadLabels({"EPICl", "EPICm", "STYLr", "STYLu", "LARMm", "LARM_elb"}, {}, Table());
  for (const ReadLabel& one : read) {
    ASSERT_FALSE(one.readings.empty());
    EXPECT_EQ(one.readings.front().side, BodySide::kNone);
  }
  EXPECT_EQ(Describe(read[0].readings.front()), "lateral epicondyle of the humerus");
  EXPECT_EQ(Describe(read[4].readings.front()), "forearm");
}

TEST(LabelReadings, NamesOfJointsAreKeypointsWhereNothingIsOnTheSkinAlone) {
  const std::vector<std::string> keypoints = {"Nose",   "LShoulder", "RShoulder", "LElbow",
                                              "LWrist", "LHip",      "LKnee",     "LHeel"};
  EXPECT_EQ(Meanings(keypoints)[6], "left centre of the knee joint");
  EXPECT_EQ(Meanings(keypoints)[5], "left centre of the hip joint");
  std::vector<std::string> markers = keypoints;
  markers.emplace_back("LASI");
  EXPECT_EQ(Meanings(markers)[6], "left lateral epicondyle of the femur");
  EXPECT_EQ(Meanings(markers)[5], "left greater trochanter");
}

// Bones begin at joints; a skeleton has no knees.
TEST(LabelReadings, NamesOfBonesAreJointsWhereNothingElseIsOnLimbs) {
  std::vector<std::string> bones = {"Hips", "Spine", "Neck", "Head"};
  for (const std::string side : {"Left", "Right"}) {
    for (const char* bone : {"UpLeg", "Leg", "Foot", "Arm", "ForeArm", "Hand", "Shoulder"}) {
      bones.push_back(side + bone);
    }
  }
  EXPECT_EQ(Meanings(bones)[5], "left centre of the knee joint");
  EXPECT_EQ(Meanings(bones)[9], "left centre of the wrist joint");
  EXPECT_EQ(Meanings(bones)[17], "right collar");
  bones.emplace_back("LeftKnee");
  EXPECT_EQ(Meanings(bones)[5], "left shank");
}

TEST(LabelReadings, WhatIsComputedIsLeftOut) {
  const std::vector<std::string> labels = {"LLFC",        "LMFC",         "LKJC", "RKJC",
                                           "LKneeAngles", "CentreOfMass", "LASI", "RASI",
                                           "LASI#2",      "SACR",         "LHJC"};
  EXPECT_THAT(
      Meanings(labels),
      ElementsAre("left lateral epicondyle of the femur", "left medial epicondyle of the femur",
                  "-", "right centre of the knee joint", "-", "-", "left anterior iliac spine",
                  "right anterior iliac spine", "-", "sacrum", "-"));
  EXPECT_EQ(ReadLabels(labels, {}, Table())[2].why_left_out, "a joint's centre beside its markers");
}

// LLEPI is a knee where LELB is the elbow.
TEST(LabelReadings, TwoLabelsAreNotOneLandmark) {
  EXPECT_THAT(Meanings({"LELB", "LLEPI"}), ElementsAre("left lateral epicondyle of the humerus",
                                                       "left lateral epicondyle of the femur"));
}

TEST(LabelReadings, NumbersAreClusters) {
  EXPECT_THAT(Meanings({"LTH1", "R_thigh12", "r_sh2", "LTB3", "shank_antsup_L", "shank_antsup_R"}),
              ElementsAre("left thigh", "right thigh", "right shank", "left shank", "left shank",
                          "right shank"));
}

/// Whole vocabularies: how many labels of each are understood.
TEST(LabelReadings, PublishedSetsAreUnderstood) {
  const std::map<std::string, std::vector<std::string>> sets = {
      {"Plug-in Gait", {"LFHD", "RBHD", "C7",   "T10",  "CLAV", "STRN", "RBAK", "LSHO", "LUPA",
                        "LELB", "LFRM", "LWRA", "LWRB", "LFIN", "LASI", "LPSI", "SACR", "LTHI",
                        "LKNE", "LTIB", "LANK", "LHEE", "LTOE", "LKNM", "LMED", "LSMH"}},
      {"IOR", {"LASIS", "LPSIS", "LGT", "LLE", "LME", "LHF", "LTT", "LLM", "LMM", "LCA", "LFM",
               "LSM",   "LVM",   "C7",  "IJ",  "PX",  "T2",  "MAI", "LA",  "L1",  "L3",  "L5"}},
      {"CAST",
       {"L_IAS", "L_IPS", "L_FTC", "L_FLE", "L_FME", "L_FAX", "L_TTC", "L_FAL", "L_TAM", "L_FCC",
        "L_FM1", "L_FM2", "L_FM5"}},
      {"Rajagopal",
       {"RACR", "RASH", "RPSH", "RLEL", "RMEL",  "RFAradius", "RFAulna", "C7",   "CLAV",
        "RASI", "RPSI", "RLFC", "RMFC", "RLMAL", "RMMAL",     "RCAL",    "RTOE", "RMT5",
        "RTH1", "RTB1", "RHJC", "RKJC", "RAJC",  "REJC",      "RSJC",    "RUA1"}},
      {"gait2354",
       {"Sternum", "R.Acromium", "Top.Head", "R.Bicep", "R.Elbow", "R.Wrist.Med", "R.ASIS",
        "V.Sacral", "R.Thigh.Upper", "R.Thigh.Front", "R.Knee.Lat", "R.Knee.Med", "R.Shank.Rear",
        "R.Ankle.Lat", "R.Heel", "R.Midfoot.Sup", "R.Midfoot.Lat", "R.Toe.Tip", "R.Toe.Lat"}},
      {"OpenCap",
       {"r.ASIS_study", "r.PSIS_study", "r_knee_study", "r_mknee_study", "r_ankle_study",
        "r_mankle_study", "r_toe_study", "r_5meta_study", "r_calc_study", "r_shoulder_study",
        "C7_study", "r_thigh1_study", "r_sh1_study", "RHJC_study", "r_lelbow_study",
        "r_melbow_study", "r_lwrist_study", "r_mwrist_study"}},
      {"Motive",
       {"HeadTop",     "HeadFront",  "HeadSide",      "BackTop",      "BackLeft",  "Chest",
        "WaistLFront", "WaistRBack", "LShoulderBack", "LShoulderTop", "LElbowOut", "LUArmHigh",
        "LHandOut",    "LWristOut",  "LWristIn",      "LHandIn",      "LThigh",    "LKneeOut",
        "LShin",       "LAnkleOut",  "LToeOut",       "LToeIn",       "LToeTip",   "LHeel"}},
      {"Qualisys sports",
       {"HeadL",     "HeadR",          "HeadFront",  "SpineThoracic2", "SpineThoracic12",
        "Chest",     "LShoulderTop",   "LArm",       "LElbowOut",      "LElbowIn",
        "LWristOut", "LWristIn",       "LHand2",     "WaistLFront",    "WaistL",
        "WaistBack", "LThighFrontLow", "LKneeOut",   "LKneeIn",        "LShinFrontHigh",
        "LAnkleOut", "LForefoot5",     "LForefoot2", "LHeelBack"}},
      {"Xsens",
       {"pHipOrigin",
        "pRightASI",
        "pRightCSI",
        "pRightIschialTub",
        "pSacrum",
        "pL5SpinalProcess",
        "pT12SpinalProcess",
        "pPX",
        "pIJ",
        "pC7SpinalProcess",
        "pTopOfHead",
        "pRightAuricularis",
        "pBackOfHead",
        "pRightAcromion",
        "pRightArmLatEpicondyle",
        "pRightArmMedEpicondyle",
        "pRightOlecranon",
        "pRightUlnarStyloid",
        "pRightRadialStyloid",
        "pRightTopOfHand",
        "pRightPinky",
        "pRightGreaterTrochanter",
        "pRightKneeLatEpicondyle",
        "pRightKneeMedEpicondyle",
        "pRightPatella",
        "pRightLatMalleolus",
        "pRightMedMalleolus",
        "pRightTibialTub",
        "pRightHeelFoot",
        "pRightFirstMetatarsal",
        "pRightFifthMetatarsal",
        "pRightPivotFoot",
        "pRightHeelCenter",
        "pRightToe",
        "jRightHip",
        "jRightKnee"}},
      {"HALPE, BODY_25, COCO",
       {"Nose", "LEye", "LEar", "LShoulder", "LElbow", "LWrist", "LHip", "LKnee", "LAnkle", "Head",
        "Neck", "Hip", "LBigToe", "LSmallToe", "LHeel", "MidHip", "left_eye", "right_knee"}},
      {"SMPL",
       {"pelvis", "left_hip", "right_hip", "spine1", "left_knee", "spine2", "left_ankle", "spine3",
        "left_foot", "neck", "left_collar", "head", "left_shoulder", "left_elbow", "left_wrist",
        "left_hand"}},
      {"Human Body Model",
       {"LGTRO", "LLEK", "LLM", "LLEE", "LMEE", "LLW", "LMW", "XYPH", "NAVE", "LDELT", "FRTHI",
        "FLTHI", "RATI", "THEAD", "FHEAD", "BBAC"}},
      {"RRIS40",
       {"RTEMP", "RHEAD", "RACR", "RHLE", "RHME", "RRSP", "RUSP", "RCAP", "RHMC2", "RFLE", "RFME",
        "RTAM", "RFAL", "RFCC", "RFMT1", "RFMT5", "STER", "XPRO"}},
      {"Oxford foot",
       {"LHFB", "LTUB", "LSHN", "LMMA", "LPCA", "LLCA", "LSTL", "LP1M", "LP5M", "LD1M", "LD5M",
        "LHLX", "LKNM"}},
      {"Shogun",
       {"ARIEL", "LFSH", "LBSH", "LIEL", "LIWR", "LOWR", "LIHAND", "LOHAND", "LFWT", "LBWT", "MBWT",
        "LKNI", "LHEL", "LRSTBEEF"}},
      {"French segments",
       {"CLD",  "CMD",  "TFIBD", "FHAD", "THAD",   "MT5D", "CALD", "ACD",   "BHPD", "ELD",   "EMD",
        "PSRD", "PSUD", "MC2D",  "COTD", "SCAPDH", "CLG",  "CMG",  "TFIBG", "FHAG", "THAG",  "MT5G",
        "CALG", "ACG",  "BHPG",  "ELG",  "EMG",    "PSRG", "PSUG", "MC2G",  "COTG", "SCAPGH"}},
      {"Azure Kinect",
       {"PELVIS", "SPINE_NAVEL", "CLAVICLE_LEFT", "HAND_LEFT", "HANDTIP_LEFT", "KNEE_LEFT"}},
      {"MediaPipe",
       {"nose", "left_eye_inner", "left_eye", "left_eye_outer", "left_ear", "mouth_left",
        "left_shoulder", "left_elbow", "left_wrist", "left_pinky", "left_index", "left_thumb",
        "left_hip", "left_knee", "left_ankle", "left_heel", "left_foot_index"}}};
  for (const auto& [name, labels] : sets) {
    std::vector<std::string> unknown;
    const std::vector<ReadLabel> read = ReadLabels(labels, {}, Table());
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (read[i].readings.empty()) unknown.push_back(labels[i]);
    }
    EXPECT_THAT(unknown, IsEmpty()) << name;
  }
}

}  // namespace
}  // namespace mmm_converter
