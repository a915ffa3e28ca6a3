// SPDX-License-Identifier: MIT
#include "tests/support/osim_texts.h"

#include <iterator>
#include <sstream>
#include <vector>

namespace mmm_converter::testing {

std::string OsimCoordinateText(const std::string& name, const std::string& more) {
  return "<Coordinate name=\"" + name + "\">" + more + "</Coordinate>\n";
}

std::string OsimAxisText(const std::string& name, const std::string& coordinate,
                         const std::string& axis, const std::string& function) {
  return "<TransformAxis name=\"" + name + "\"><coordinates> " + coordinate +
         "\n</coordinates><axis>" + axis + "</axis>" + function + "</TransformAxis>\n";
}

std::string OsimBodyText(const std::string& name) {
  return "<Body name=\"" + name + "\"><mass>1</mass><mass_center>0 0.1 0</mass_center><inertia>" +
         "0.01 0.02 0.03 0.001 0 0</inertia></Body>\n";
}

std::string OsimJointText(const std::string& type, const std::string& name,
                          const std::string& parent, const std::string& child,
                          const std::string& more) {
  const std::string in = parent == "ground" ? "/ground" : "/bodyset/" + parent;
  return "<" + type + " name=\"" + name + "\"><socket_parent_frame>" + parent +
         "_offset</socket_parent_frame><socket_child_frame>" + child +
         "_offset</socket_child_frame>" + more + "<frames><PhysicalOffsetFrame name=\"" + parent +
         "_offset\"><socket_parent>" + in +
         "</socket_parent><translation>0.1 -0.2 0.05</translation><orientation>0.3 -0.2 "
         "0.1</orientation></PhysicalOffsetFrame><PhysicalOffsetFrame name=\"" +
         child + "_offset\"><socket_parent>/bodyset/" + child +
         "</socket_parent><translation>0.02 0.15 -0.01</translation><orientation>-0.1 0.4 "
         "0.2</orientation></PhysicalOffsetFrame></frames></" +
         type + ">\n";
}

std::string OsimMarkerText(const std::string& name, const std::string& body,
                           const std::string& location) {
  return "<Marker name=\"" + name + "\"><socket_parent_frame>/bodyset/" + body +
         "</socket_parent_frame><location>" + location + "</location></Marker>\n";
}

std::string OsimText(const std::string& bodies, const std::string& joints,
                     const std::string& constraints, const std::string& markers) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<OpenSimDocument Version=\"40000\">\n"
         "<Model name=\"made\"><Ground name=\"ground\"/>\n<BodySet name=\"bodyset\"><objects>\n" +
         bodies + "</objects></BodySet>\n<JointSet name=\"jointset\"><objects>\n" + joints +
         "</objects></JointSet>\n<ConstraintSet name=\"constraintset\"><objects>\n" + constraints +
         "</objects></ConstraintSet>\n<MarkerSet name=\"markerset\"><objects>\n" + markers +
         "</objects></MarkerSet></Model></OpenSimDocument>\n";
}

namespace {

constexpr const char* kLine =
    "<LinearFunction name=\"function\"><coefficients>1 0</coefficients>"
    "</LinearFunction>";

std::string Root() {
  std::string axes = OsimAxisText("rotation1", "tilt", "0 0 1", kLine) +
                     OsimAxisText("rotation2", "list", "1 0 0", kLine) +
                     OsimAxisText("rotation3", "turn", "0 1 0", kLine) +
                     OsimAxisText("translation1", "tx", "1 0 0", kLine) +
                     OsimAxisText("translation2", "ty", "0 1 0",
                                  "<MultiplierFunction name=\"function\"><function>"
                                  "<LinearFunction><coefficients>1 0</coefficients>"
                                  "</LinearFunction></function><scale>1.1</scale>"
                                  "</MultiplierFunction>") +
                     OsimAxisText("translation3", "tz", "0 0 1", kLine);
  std::string coordinates;
  for (const char* name : {"tilt", "list", "turn", "tx", "tz"}) {
    coordinates += OsimCoordinateText(name);
  }
  coordinates += OsimCoordinateText("ty", "<default_value>0.9</default_value>");
  return OsimJointText("CustomJoint", "ground_pelvis", "ground", "pelvis",
                       "<coordinates>" + coordinates + "</coordinates><SpatialTransform>" + axes +
                           "</SpatialTransform>");
}

/// Two turns and three shifts by one coordinate, about oblique axes, by functions of all kinds.
std::string Knee() {
  return OsimJointText(
      "CustomJoint", "knee", "thigh", "shank",
      "<coordinates>" +
          OsimCoordinateText("knee_angle",
                             "<range>-2.1 0.2</range><clamped>true</clamped>"
                             "<default_value>-0.3</default_value>") +
          "</coordinates><SpatialTransform>" +
          OsimAxisText("rotation1", "knee_angle", "0.2 0.1 -1",
                       "<LinearFunction name=\"function\"><coefficients>-1 0.05</coefficients>"
                       "</LinearFunction>") +
          OsimAxisText("rotation2", "knee_angle", "1 0.3 0",
                       "<SimmSpline name=\"function\"><x>-2 -1.5 -0.9 -0.2 0.1</x>"
                       "<y>0.2 0.15 0.02 0.01 -0.05</y></SimmSpline>") +
          OsimAxisText("rotation3", "", "0 1 0",
                       "<Constant name=\"function\"><value>0.1</value></Constant>") +
          OsimAxisText("translation1", "knee_angle", "1 0 0",
                       "<function><MultiplierFunction><function><NaturalCubicSpline>"
                       "<x>-2 -1 0</x><y>0.01 0.005 -0.01</y></NaturalCubicSpline></function>"
                       "<scale>1.2</scale></MultiplierFunction></function>") +
          OsimAxisText("translation2", "knee_angle", "0 1 0",
                       "<PolynomialFunction name=\"function\"><coefficients>0.01 -0.02 0.003 0.04"
                       "</coefficients></PolynomialFunction>") +
          OsimAxisText("translation3", "knee_angle", "0 0.5 1",
                       "<PiecewiseLinearFunction name=\"function\"><x>-2 -0.77 0.3</x>"
                       "<y>0 0.02 -0.01</y></PiecewiseLinearFunction>") +
          "</SpatialTransform>");
}

}  // namespace

std::string OsimOfAllKinds() {
  std::string bodies;
  std::string markers;
  for (const char* name : {"pelvis", "thigh", "shank", "patella", "foot", "toes", "trunk", "arm",
                           "hand", "head", "tool", "cart"}) {
    bodies += OsimBodyText(name);
    const std::string of = name;
    markers += OsimMarkerText(of + "1", of, "0.1 0.02 0.03") +
               OsimMarkerText(of + "2", of, "-0.05 0.1 0.02") +
               OsimMarkerText(of + "3", of, "0.02 -0.06 0.09");
  }
  const std::string patella =
      "<coordinates>" + OsimCoordinateText("patella_angle") + "</coordinates><SpatialTransform>" +
      OsimAxisText("rotation1", "patella_angle", "0 0 1",
                   "<SimmSpline name=\"function\"><x>-2 -1 0 0.5</x><y>-1.7 -0.9 0 0.3</y>"
                   "</SimmSpline>") +
      OsimAxisText("translation1", "patella_angle", "1 0 0", kLine) + "</SpatialTransform>";
  const std::string joints =
      Root() + OsimJointText("BallJoint", "hip", "pelvis", "thigh") + Knee() +
      OsimJointText("CustomJoint", "patellofemoral", "thigh", "patella", patella) +
      OsimJointText("UniversalJoint", "ankle", "shank", "foot") +
      OsimJointText("PinJoint", "mtp", "foot", "toes",
                    "<coordinates>" +
                        OsimCoordinateText("mtp_angle",
                                           "<locked>true</locked>"
                                           "<default_value>0.2</default_value>") +
                        "</coordinates>") +
      OsimJointText("GimbalJoint", "back", "pelvis", "trunk") +
      OsimJointText("SliderJoint", "shoulder", "trunk", "arm") +
      OsimJointText("WeldJoint", "wrist", "arm", "hand") +
      OsimJointText("PlanarJoint", "neck", "trunk", "head") +
      OsimJointText("FreeJoint", "grip", "hand", "tool") +
      OsimJointText("PinJoint", "wheel", "tool", "cart",
                    "<coordinates>" +
                        OsimCoordinateText("wheel_angle", "<default_value>0.7</default_value>") +
                        "</coordinates>");
  const std::string coupler =
      "<CoordinateCouplerConstraint name=\"follow\"><coupled_coordinates_function>"
      "<SimmSpline><x>-2 -1 0 1</x><y>-1 -0.7 0 0.4</y></SimmSpline>"
      "</coupled_coordinates_function><independent_coordinate_names>knee_angle"
      "</independent_coordinate_names><dependent_coordinate_name>patella_angle"
      "</dependent_coordinate_name><scale_factor>0.8</scale_factor>"
      "</CoordinateCouplerConstraint>\n";
  return OsimText(bodies, joints, coupler, markers);
}

Eigen::MatrixXd OsimCoordinates(const std::string& motion, const CoordinateMap& map) {
  std::istringstream lines(motion.substr(motion.find("endheader") + 9));
  std::string line;
  while (line.find("time") == std::string::npos && std::getline(lines, line)) continue;
  std::istringstream head(line);
  const std::vector<std::string> columns{std::istream_iterator<std::string>(head), {}};
  const auto& all = map.coordinates();
  std::vector<Eigen::VectorXd> rows;
  for (double number = 0; std::getline(lines, line);) {
    std::istringstream cells(line);
    Eigen::VectorXd& row = rows.emplace_back(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) row[static_cast<int>(i)] = all[i].rest;
    for (const std::string& column : columns) {
      cells >> number;
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].name != column) continue;
        const bool is_turn = all[i].kind == ModelCoordinate::Kind::kTurn;
        row[static_cast<int>(i)] = is_turn ? number * EIGEN_PI / 180 : number;
      }
    }
    if (!cells) rows.pop_back();
  }
  Eigen::MatrixXd values(all.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) values.col(static_cast<int>(k)) = rows[k];
  return values;
}

}  // namespace mmm_converter::testing
