// SPDX-License-Identifier: MIT
#include "common/label/learn/usual_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace mmm_converter {
namespace {

/// Names of one part of the body, and KIT's names of markers on the sites that it can be.
struct UsualNames {
  bool has_sides;          // a name without side is none of these
  std::string_view names;  // with blanks around each
  std::string_view near;
};

// Epicondyles are on the bone above the joint, styloids on the one below it; malleoli are on the
// shank, where the MMM model's markers of the ankle are not.
constexpr UsualNames kUsualNames[] = {
    {false,
     " head hd fhd bhd mhd thd forehead headfront headback headtop tophead fhead bhead vertex ear "
     "temple nose chin glabella inion occiput mastoid tragus ",
     "FHD BHD"},
    {true, " head hd fhd bhd mhd ear temple eye tragus mastoid ", "FHD BHD"},
    {false,
     " c6 c7 cv6 cv7 t1 t2 t3 t4 t5 t6 t7 t8 t9 t10 t11 t12 tv1 tv2 tv3 tv5 tv7 tv8 tv10 tv12 clav "
     "clavicle clv ij jn sn sjn suprasternale jugularnotch strn stern sternum sterno xiph xiphoid "
     "px manubrium chest thorax trunk torso back upperback ",
     "C7 CLAV STRN T10 BAK"},
    {true, " bak bac back scap scapula clavicle clav chest thorax trunk torso rib ",
     "BAK CLAV STRN SHO"},
    {false, " l1 l2 l3 l4 l5 lv1 lv2 lv3 lv4 lv5 lumbar lowerback ", "L3 STRN"},
    {false, " sacr sac sacrum vsac sacral vsacral mpsi mpsis pelvis pelv pel waist ", "PSI"},
    {true,
     " asi asis sias ias psi psis sips ips fwt bwt ic icr ilc iliac iliaccrest crest pelvis pelv "
     "pel waist ",
     "ASI PSI"},
    {true, " hip gt gtr gtroch troch trochanter greatertrochanter ftc ", "HIP THI"},
    {true, " sho shoa shop shof shob shoulder shl shld shldr ac acr acro acrom acromion acj sae ",
     "SHO CLAV"},
    {true, " upa uparm upperarm uarm ua arm hum humerus bicep biceps tricep triceps delt deltoid ",
     "UPA"},
    {true,
     " elb elbl elbm elbow elbw elbowl elbowm mel lel ael lep mep hle hme epicondyle "
     "humeralepicondyle ",
     "AEL UPA"},
    {true, " aol ole olecranon ", "AOL FRA"},
    {true, " fra frm farm forearm lowerarm fa ", "FRA"},
    {true,
     " wra wrb wri wrist wts wps wrr wru wristr wristu rad uln radius ulna rsp usp radialstyloid "
     "ulnarstyloid radstyl ulnstyl ",
     "WTS WPS FRA"},
    {true,
     " fin finger fing hand hnd palm hts hps ifd ifp mc2 mc3 mc5 mcp mcp2 mcp3 mcp5 2mc 3mc 5mc "
     "hm2 hm5 knuckle thumb index middlefinger pinky ",
     "HTS HPS IFD"},
    {true, " thi thigh thg th quad femur fem ", "THI"},
    {true,
     " kne knel knem mkne lkne knee kneel kneem mknee lknee fle fme lfc mfc lfe mfe "
     "femoralepicondyle ",
     "KNE THI"},
    {true,
     " tib tibia tip shn shin shank shk calf leg lowerleg fib fibula fibhead fibulahead fh hf tt "
     "ttub tibtub tibialtuberosity tuberosity ",
     "TIP"},
    {true,
     " ank ankl ankm mank lank ankle anklel anklem mankle lankle mal malleolus lmal mmal lm mm fal "
     "tam ",
     "ANK TIP"},
    {true, " hee heel cal calc calcaneus fcc ", "HEE"},
    {true,
     " mt mt1 mt2 mt3 mt4 mt5 met met1 met2 met5 meta meta1 meta2 meta5 1mt 2mt 5mt 1met 2met 5met "
     "1meta 2meta 5meta 1stmet 2ndmet 5thmet 1stmeta 5thmeta mth1 mth2 mth5 1mth 2mth 5mth fm1 fm2 "
     "fm5 metatarsal 1stmetatarsal 2ndmetatarsal 5thmetatarsal mtp1 mtp5 1mtp 5mtp ",
     "MT1 MT5"},
    {true, " toe toes toetip ", "TOE MT1 MT5"},
    {true, " bigtoe hallux halx ", "TOE"},
    {true, " foot ft midfoot forefoot instep navicular nav cuboid ", "MT1 MT5 ANK"}};

constexpr std::array<std::string_view, 10> kSides = {"left", "right", "links", "rechts", "lft",
                                                     "rgt",  "lt",    "rt",    "l",      "r"};

// Where on a part; says nothing of which.
constexpr std::array<std::string_view, 34> kModifiers = {
    "lateralis", "medialis", "posterior", "anterior", "proximal", "superior", "inferior",
    "lateral",   "outside",  "medial",    "distal",   "middle",   "inside",   "bottom",
    "upper",     "lower",    "front",     "inner",    "outer",    "rear",     "prox",
    "dist",      "post",     "ant",       "lat",      "med",      "sup",      "inf",
    "top",       "mid",      "out",       "ext",      "int",      "in"};

/// In lower case, apart where punctuation or a change from small to capital letters parts them.
std::vector<std::string> Words(std::string_view label) {
  std::vector<std::string> words(1);
  char before = ' ';
  for (const char c : label) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_new = !std::isalnum(byte) ||
                        (std::isupper(byte) && std::islower(static_cast<unsigned char>(before)));
    if (is_new && !words.back().empty()) words.emplace_back();
    if (std::isalnum(byte)) words.back() += static_cast<char>(std::tolower(byte));
    before = c;
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

const UsualNames* Find(const std::string& name, bool has_side) {
  const std::string word = " " + name + " ";
  for (const UsualNames& usual : kUsualNames) {
    if (usual.has_sides == has_side && usual.names.find(word) != std::string_view::npos) {
      return &usual;
    }
  }
  return nullptr;
}

/// Without what is at its beginning or end, where more is left than a letter.
std::optional<std::string> Without(std::string_view part, const std::string& name, bool at_end) {
  if (name.size() < part.size() + 2) return std::nullopt;
  if (at_end ? !name.ends_with(part) : !name.starts_with(part)) return std::nullopt;
  return at_end ? name.substr(0, name.size() - part.size()) : name.substr(part.size());
}

/// As it is, without one or two modifiers, or without a number at the end.
const UsualNames* FindBase(const std::string& name, bool has_side, int modifiers = 2) {
  if (const UsualNames* found = Find(name, has_side)) return found;
  for (const std::string_view modifier : kModifiers) {
    for (const bool at_end : {true, false}) {
      const auto rest = Without(modifier, name, at_end);
      if (!rest || modifiers == 0) continue;
      if (const UsualNames* found = FindBase(*rest, has_side, modifiers - 1)) return found;
    }
  }
  std::size_t letters = name.size();
  while (letters > 0 && std::isdigit(static_cast<unsigned char>(name[letters - 1]))) --letters;
  return letters < name.size() && letters > 1 ? Find(name.substr(0, letters), has_side) : nullptr;
}

const UsualNames* FindUsual(std::string_view label) {
  std::vector<std::string> words = Words(label);
  std::string whole;
  for (const std::string& word : words) whole += word;
  if (const UsualNames* found = Find(whole, false)) return found;
  const auto side = std::find_if(words.begin(), words.end(), [](const std::string& word) {
    return std::find(kSides.begin(), kSides.end(), word) != kSides.end();
  });
  if (side != words.end()) {
    words.erase(side);
    std::string rest;
    for (const std::string& word : words) rest += word;
    if (const UsualNames* found = FindBase(rest, true)) return found;
  }
  for (const bool at_end : {false, true}) {
    for (const std::string_view one : kSides) {
      const auto rest = Without(one, whole, at_end);
      if (!rest) continue;
      if (const UsualNames* found = FindBase(*rest, true)) return found;
    }
  }
  return FindBase(whole, false);
}

std::vector<std::string_view> Split(std::string_view text) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

/// Whether a site has a marker of one of these names, of either side.
bool HasMarker(const KinematicModel& model, const BodySite& site,
               const std::vector<std::string_view>& names) {
  constexpr std::string_view kPrefix = "MARKER_";
  return std::any_of(site.markers.begin(), site.markers.end(), [&](MarkerIx marker) {
    std::string_view name = model.markers()[marker].name;
    if (name.starts_with(kPrefix)) name.remove_prefix(kPrefix.size());
    const bool has_side = name.starts_with('L') || name.starts_with('R');
    return std::any_of(names.begin(), names.end(), [&](std::string_view one) {
      return name == one || (has_side && name.substr(1) == one);
    });
  });
}

}  // namespace

std::vector<std::string_view> UsuallyNear(std::string_view label) {
  constexpr std::size_t kLongest = 40;  // names are shorter
  if (label.size() > kLongest) return {};
  const UsualNames* const usual = FindUsual(label);
  return usual == nullptr ? std::vector<std::string_view>() : Split(usual->near);
}

Eigen::MatrixXi WhatNamesSay(const std::vector<std::string>& labels, const BodySites& sites) {
  Eigen::MatrixXi said = Eigen::MatrixXi::Zero(static_cast<Eigen::Index>(labels.size()),
                                               static_cast<Eigen::Index>(sites.sites().size()));
  for (Eigen::Index l = 0; l < said.rows(); ++l) {
    const auto near = UsuallyNear(labels[static_cast<std::size_t>(l)]);
    if (near.empty()) continue;
    for (Eigen::Index s = 0; s < said.cols(); ++s) {
      const BodySite& site = sites.sites()[static_cast<std::size_t>(s)];
      said(l, s) = HasMarker(sites.model(), site, near) ? 1 : -1;
    }
    if (said.row(l).maxCoeff() < 0) said.row(l).setZero();
  }
  return said;
}

}  // namespace mmm_converter
