// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/osim/osim_model_reader.h"
#include "common/support/error.h"
#include "tests/support/osim_texts.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using testing::OsimAxisText;
using testing::OsimBodyText;
using testing::OsimCoordinateText;
using testing::OsimJointText;
using testing::OsimMarkerText;
using testing::OsimText;

std::string OsimMessage(const std::string& text) {
  try {
    ParseOsimModel(text, "m.osim");
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("m.osim")) << text.substr(0, 200);
    return error.what();
  }
  return "no error";
}

/// One body on the ground by a Pin joint, one word of it replaced.
std::string With(const std::string& what, const std::string& instead) {
  std::string text = OsimText(OsimBodyText("b"), OsimJointText("PinJoint", "j", "ground", "b"));
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), instead);
}

std::string WithFunction(const std::string& function) {
  return OsimText(
      OsimBodyText("b"),
      OsimJointText("CustomJoint", "j", "ground", "b",
                    "<coordinates>" + OsimCoordinateText("q") + "</coordinates><SpatialTransform>" +
                        OsimAxisText("rotation1", "q", "0 0 1", function) + "</SpatialTransform>"));
}

TEST(OsimRefuses, WhatIsNoModel) {
  EXPECT_THAT(OsimMessage("<OpenSimDocument Version=\"40000\"/>"), HasSubstr("holds no <Model>"));
  EXPECT_THAT(OsimMessage("<Robot/>"), HasSubstr("m.osim:1: <Robot> is not <OpenSimDocument>"));
  EXPECT_THAT(OsimMessage("<OpenSimDocument Version=\"40000\"><Model>"),
              HasSubstr("not well-formed XML"));
  EXPECT_THAT(OsimMessage(With("\"40000\"", "\"30516\"")),
              HasSubstr("Version 30516 of OpenSim's files is not read"));
  EXPECT_THAT(OsimMessage(With("\"40000\"", "\"nan\"")), HasSubstr("says no Version"));
  EXPECT_THAT(OsimMessage(OsimText("", "")), HasSubstr("the model has no bodies"));
  EXPECT_THAT(OsimMessage("<!DOCTYPE a [<!ENTITY a \"aa\"><!ENTITY b \"&a;&a;\">]>"
                          "<OpenSimDocument Version=\"&b;\"/>"),
              HasSubstr("m.osim"));
}

TEST(OsimRefuses, WhatMovesBodiesAndIsNotReadByName) {
  EXPECT_THAT(OsimMessage(OsimText(OsimBodyText("b"),
                                   OsimJointText("ScapulothoracicJoint", "scap", "ground", "b"))),
              HasSubstr("joint 'scap' is a ScapulothoracicJoint, which is not read"));
  const std::string point =
      "<PointConstraint name=\"p\"><isEnforced>true</isEnforced>"
      "</PointConstraint>";
  const std::string joint = OsimJointText("PinJoint", "j", "ground", "b");
  EXPECT_THAT(OsimMessage(OsimText(OsimBodyText("b"), joint, point)),
              HasSubstr("constraint 'p' is a PointConstraint, which is not read"));
  EXPECT_EQ(OsimMessage(OsimText(OsimBodyText("b"), joint,
                                 "<PointConstraint name=\"p\"><isEnforced>false</isEnforced>"
                                 "</PointConstraint>")),
            "no error");
  EXPECT_THAT(OsimMessage(WithFunction("<GCVSpline name=\"function\"/>")),
              HasSubstr("<GCVSpline>: is not read"));
  EXPECT_THAT(OsimMessage(With("<frames>",
                               "<coordinates><Coordinate name=\"q\"><prescribed>true"
                               "</prescribed></Coordinate></coordinates><frames>")),
              HasSubstr("coordinate 'q' is prescribed"));
  EXPECT_THAT(OsimMessage(With("<Ground name=\"ground\"/>",
                               "<components><WeldConstraint name=\"w\"/></components>")),
              HasSubstr("<WeldConstraint name=\"w\"> in <components> is not read"));
}

TEST(OsimRefuses, TreesThatAreNone) {
  const std::string two = OsimBodyText("a") + OsimBodyText("b");
  EXPECT_THAT(OsimMessage(OsimText(two, OsimJointText("PinJoint", "j", "b", "a") +
                                            OsimJointText("PinJoint", "k", "a", "b"))),
              HasSubstr("body 'a' hangs in a circle of joints"));
  EXPECT_THAT(OsimMessage(OsimText(two, OsimJointText("PinJoint", "j", "ground", "a"))),
              HasSubstr("body 'b' has no joint that carries it"));
  EXPECT_THAT(OsimMessage(OsimText(two, OsimJointText("PinJoint", "j", "ground", "a") +
                                            OsimJointText("PinJoint", "k", "a", "b") +
                                            OsimJointText("PinJoint", "l", "ground", "b"))),
              HasSubstr("joint 'l' carries body 'b', which joint 'k' carries already"));
  EXPECT_THAT(OsimMessage(OsimText(OsimBodyText("a") + OsimBodyText("a"),
                                   OsimJointText("PinJoint", "j", "ground", "a"))),
              HasSubstr("body 'a' is there twice"));
}

TEST(OsimRefuses, FramesThatAreNotThere) {
  EXPECT_THAT(OsimMessage(With("/bodyset/b</socket", "/bodyset/c</socket")),
              HasSubstr("joint 'j' hangs on \"/bodyset/c\", which is no body and no offset frame"));
  EXPECT_THAT(OsimMessage(With("<socket_parent>/bodyset/b<", "<socket_parent>../b_offset<")),
              HasSubstr("which hangs on itself"));
  EXPECT_THAT(OsimMessage(With("ground_offset</socket_parent_frame>", "</socket_parent_frame>")),
              HasSubstr("joint 'j' names no frame that it hangs on"));
  EXPECT_THAT(OsimMessage(OsimText(OsimBodyText("b"), OsimJointText("PinJoint", "j", "ground", "b"),
                                   "", OsimMarkerText("m", "x", "0 0 0"))),
              HasSubstr("marker 'm' hangs on \"/bodyset/x\""));
}

TEST(OsimRefuses, NumbersThatAreNone) {
  EXPECT_THAT(OsimMessage(With("0.1 -0.2 0.05", "0.1 NaN 0.05")),
              HasSubstr("<translation>: \"0.1 NaN 0.05\" is not 3 finite numbers"));
  EXPECT_THAT(OsimMessage(With("0 0.1 0", "0 0.1")), HasSubstr("is not 3 finite numbers"));
  EXPECT_THAT(OsimMessage(With("<mass>1", "<mass>-1")), HasSubstr("negative mass"));
  EXPECT_THAT(OsimMessage(With("<mass>1", "<mass>1e999")), HasSubstr("<mass>"));
  EXPECT_THAT(OsimMessage(With("<frames>",
                               "<coordinates><Coordinate name=\"q\"><range>2 1</range>"
                               "</Coordinate></coordinates><frames>")),
              HasSubstr("<range>: \"2 1\" is not two numbers, the lower first"));
  EXPECT_THAT(OsimMessage(With("<frames>",
                               "<coordinates><Coordinate name=\"q\"><clamped>maybe"
                               "</clamped></Coordinate></coordinates><frames>")),
              HasSubstr("\"maybe\" is neither true nor false"));
}

TEST(OsimRefuses, FunctionsThatAreNone) {
  const auto spline = [](const std::string& x, const std::string& y) {
    return WithFunction("<SimmSpline name=\"function\"><x>" + x + "</x><y>" + y +
                        "</y></SimmSpline>");
  };
  EXPECT_THAT(OsimMessage(spline("1", "1")), HasSubstr("has 1 numbers in <x> and 1 in <y>"));
  EXPECT_THAT(OsimMessage(spline("0 1 2", "1 2")), HasSubstr("has 3 numbers in <x> and 2 in <y>"));
  EXPECT_THAT(OsimMessage(spline("0 2 1", "1 2 3")), HasSubstr("<x> must not descend"));
  EXPECT_THAT(OsimMessage(spline("0 1e-300 2e-300 3", "0 1e300 -1e300 1e305")),
              HasSubstr("is not a list of finite numbers"));
  EXPECT_THAT(OsimMessage(WithFunction("<LinearFunction name=\"function\"><coefficients>1 2 3"
                                       "</coefficients></LinearFunction>")),
              HasSubstr("has 3 coefficients for 1 coordinates"));
  EXPECT_THAT(OsimMessage(WithFunction("<MultiplierFunction name=\"function\"/>")),
              HasSubstr("has no function"));
  std::string nested = "<Constant/>";
  for (int i = 0; i < 30; ++i) {
    nested.insert(0, "<MultiplierFunction><function>").append("</function></MultiplierFunction>");
  }
  EXPECT_THAT(OsimMessage(WithFunction("<function>" + nested + "</function>")),
              HasSubstr("nested too deeply"));
}

TEST(OsimRefuses, FunctionsBeyondWhatABodyCanDo) {
  std::string scaled = "<LinearFunction><coefficients>1 0</coefficients></LinearFunction>";
  for (int i = 0; i < 4; ++i) {
    scaled.insert(0, "<MultiplierFunction><scale>1e9</scale><function>");
    scaled += "</function></MultiplierFunction>";
  }
  EXPECT_THAT(OsimMessage(WithFunction("<function>" + scaled + "</function>")),
              HasSubstr("beyond what a body can do"));
  std::string coefficients;
  for (int i = 0; i < 100; ++i) coefficients += "1 ";
  EXPECT_THAT(OsimMessage(WithFunction("<PolynomialFunction name=\"function\"><coefficients>" +
                                       coefficients + "</coefficients></PolynomialFunction>")),
              HasSubstr("has 100 coefficients, more than the 32 that are read"));
  EXPECT_THAT(OsimMessage(With("0.1 -0.2 0.05", "0.1 -2000 0.05")),
              HasSubstr("it is away from its parent by more than 100 m"));
}

TEST(OsimRefuses, CouplersOfNothingAndOfThemselves) {
  const auto coupled = [](const std::string& dependent, const std::string& leader) {
    return OsimText(OsimBodyText("b"), OsimJointText("UniversalJoint", "j", "ground", "b"),
                    "<CoordinateCouplerConstraint name=\"c\"><coupled_coordinates_function>"
                    "<LinearFunction><coefficients>1 0</coefficients></LinearFunction>"
                    "</coupled_coordinates_function><independent_coordinate_names>" +
                        leader + "</independent_coordinate_names><dependent_coordinate_name>" +
                        dependent + "</dependent_coordinate_name></CoordinateCouplerConstraint>");
  };
  EXPECT_THAT(OsimMessage(coupled("j_coord_0", "nobody")),
              HasSubstr("coupler 'c': the model has no coordinate \"nobody\""));
  EXPECT_THAT(OsimMessage(coupled("j_coord_0", "j_coord_0")), HasSubstr("follows itself"));
}

TEST(OsimRefuses, ModelsWithoutBounds) {
  std::string bodies;
  for (int i = 0; i < 10000; ++i) bodies += "<Body name=\"b" + std::to_string(i) + "\"/>";
  EXPECT_THAT(OsimMessage(OsimText(bodies, "")),
              HasSubstr("has more than the 2048 bodies that are read"));
}

TEST(OsimRefuses, MarkerFilesWithoutBounds) {
  Diagnostics diagnostics("m.osim");
  OsimDocument document = ParseOsim(
      OsimText(OsimBodyText("b"), OsimJointText("PinJoint", "j", "ground", "b")), {}, &diagnostics);
  std::string markers = "<MarkerSet><objects>";
  for (int i = 0; i < 5000; ++i) {
    markers += "<Marker name=\"m" + std::to_string(i) + "\"><body>b</body></Marker>";
  }
  EXPECT_THAT(
      [&] { AddOsimMarkers(markers + "</objects></MarkerSet>", "mf.xml", &document, nullptr); },
      ::testing::ThrowsMessage<Error>(::testing::AllOf(HasSubstr("mf.xml:"), HasSubstr("4096"))));
}

}  // namespace
}  // namespace mmm_converter
