// SPDX-License-Identifier: MIT
#include "common/io/robot/robot_exports.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "common/io/tables/npz_writer.h"
#include "common/math/rotation.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// A value that Python's pickle reads back: a number, a text, a NumPy array, a list of texts, or a
/// dict of such values by texts.
struct PickleValue {
  struct Item;
  using Dict = std::vector<Item>;
  std::variant<double, std::int64_t, std::string, NpyArray, std::vector<std::string>, Dict> value;
};

struct PickleValue::Item {
  std::string key;
  PickleValue value;
};

template <typename Number>
void AppendLittleEndian(Number number, std::string* out) {
  char bytes[sizeof number];
  std::memcpy(bytes, &number, sizeof number);
  out->append(bytes, sizeof number);
}

/// Opcodes as Python's module pickletools describes them.
class Pickler {
 public:
  std::string Write(const PickleValue& value) {
    out_ = "\x80\x03";  // PROTO
    std::visit([this](const auto& one) { Put(one); }, value.value);
    return std::move(out_) + ".";  // STOP
  }

 private:
  void Put(double number) {
    out_ += 'G';  // BINFLOAT, big-endian
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    for (std::size_t i = sizeof number; i-- > 0;) out_ += bytes[i];
  }
  void Put(std::int64_t number) {
    out_ += "\x8a\x08";  // LONG1
    AppendLittleEndian(number, &out_);
  }
  void Put(const std::string& raw) {
    const std::string text = ToUtf8(raw);
    out_ += 'X';  // BINUNICODE
    AppendLittleEndian(static_cast<std::uint32_t>(text.size()), &out_);
    out_ += text;
  }
  void PutBytes(const char* bytes, std::size_t size) {
    if (size > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(
          "an array has 4 GB or more, for which a pickle of this kind has no room; write fewer "
          "frames");
    }
    out_ += 'B';  // BINBYTES
    AppendLittleEndian(static_cast<std::uint32_t>(size), &out_);
    out_.append(bytes, size);
  }
  void PutGlobal(const char* module, const char* name) {
    out_ += fmt::format("c{}\n{}\n", module, name);  // GLOBAL
  }

  void Put(const std::vector<std::string>& texts) {
    out_ += "](";  // EMPTY_LIST MARK
    for (const std::string& text : texts) Put(text);
    out_ += 'e';  // APPENDS
  }
  void Put(const PickleValue::Dict& dict) {
    out_ += "}(";  // EMPTY_DICT MARK
    for (const auto& [key, value] : dict) {
      Put(key);
      std::visit([this](const auto& one) { Put(one); }, value.value);
    }
    out_ += 'u';  // SETITEMS
  }
  /// _reconstruct(ndarray, (0,), b"b") and its state: (1, shape, dtype, False, bytes).
  void Put(const NpyArray& array) {
    PutGlobal("numpy.core.multiarray", "_reconstruct");
    PutGlobal("numpy", "ndarray");
    out_ += "K";  // BININT1
    out_ += '\0';
    out_ += "\x85";  // TUPLE1
    out_ +=
        "C\x01"  // SHORT_BINBYTES
        "b";
    out_ += "\x87R(K\x01(";  // TUPLE3 REDUCE MARK 1 MARK
    for (const std::int64_t size : array.shape) Put(size);
    out_ += 't';  // TUPLE
    PutDoubleType();
    out_ += "\x89";  // NEWFALSE
    PutBytes(reinterpret_cast<const char*>(array.numbers.data()),
             array.numbers.size() * sizeof(double));
    out_ += "tb";  // TUPLE BUILD
  }
  /// dtype("f8", False, True) and its state: (3, "<", None, None, None, -1, -1, 0).
  void PutDoubleType() {
    PutGlobal("numpy", "dtype");
    Put(std::string("f8"));
    out_ += "\x89\x88\x87R(K\x03";  // NEWFALSE NEWTRUE TUPLE3 REDUCE MARK 3
    Put(std::string("<"));
    out_ += "NNN";
    Put(std::int64_t{-1});
    Put(std::int64_t{-1});
    out_ += "K";
    out_ += '\0';
    out_ += "tb";
  }

  std::string out_;
};

/// A pickle of protocol 3 (Python 3.0 and later) whose arrays are NumPy's own (numpy.ndarray of
/// float64), as pickle.load and joblib.load read them with NumPy 1 and 2. An array's name is not
/// written.
/// @throws Error where an array has 4 GiB or more.
std::string FormatPickle(const PickleValue& value) { return Pickler().Write(value); }

constexpr double kLafanRate = 30;  // [Hz]
constexpr double kMimicRate = 50;  // [Hz], of BeyondMimic's and mjlab's tasks
constexpr int kJointFree = 0, kJointSlide = 2, kJointHinge = 3;  // MuJoCo's mjtJoint

NpyArray Array(const std::string& name, const Eigen::MatrixXd& columns,
               std::vector<std::int64_t> shape_of_frame) {
  NpyArray array;
  array.name = name;
  array.shape = {columns.cols()};
  array.shape.insert(array.shape.end(), shape_of_frame.begin(), shape_of_frame.end());
  array.numbers.assign(columns.data(), columns.data() + columns.size());
  return array;
}

NpyArray Array(const std::string& name, const Eigen::MatrixXd& columns) {
  return Array(name, columns, {columns.rows()});
}

NpyArray Number(const std::string& name, double number) { return {name, {}, {number}, {}}; }

NpyArray Texts(const std::string& name, const std::vector<std::string>& texts) {
  return {name, {static_cast<std::int64_t>(texts.size())}, {}, texts};
}

NpyArray Integers(const std::string& name, std::vector<std::int64_t> shape,
                  std::vector<std::int64_t> integers) {
  return {name, std::move(shape), {}, {}, std::move(integers)};
}

Eigen::MatrixXd ScalarLast(const Eigen::MatrixXd& wxyz) {
  Eigen::MatrixXd xyzw(wxyz.rows(), wxyz.cols());
  xyzw << wxyz.bottomRows<3>(), wxyz.topRows<1>();
  return xyzw;
}

void AppendJsonText(const std::string& text, std::string* json) {
  *json += '"';
  for (const char c : ToUtf8(text)) {
    if (c == '"' || c == '\\') *json += '\\';
    *json += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  *json += '"';
}

void AppendNames(const char* key, const std::vector<std::string>& names, std::string* json) {
  *json += fmt::format("  \"{}\": [", key);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) *json += ", ";
    AppendJsonText(names[i], json);
  }
  *json += "]";
}

std::vector<std::string> NamesOf(const Robot& robot, const std::vector<int>& links) {
  std::vector<std::string> names;
  names.reserve(links.size());
  for (const int link : links) names.push_back(robot.links[static_cast<std::size_t>(link)].name);
  return names;
}

std::string NamesFile(const std::string& file) { return file + ".names.json"; }

/// Beside a file that has no names.
void WriteNames(const std::string& file, const Robot& robot, const RobotMotion& motion,
                const char* quaternion) {
  std::string json = fmt::format(
      "{}{},\n  \"quaternion\": \"{}\",\n  \"robot\": ", kRobotNamesBegin, motion.rate, quaternion);
  AppendJsonText(robot.model.name(), &json);
  json += ",\n";
  AppendNames("joints", motion.joints, &json);
  json += ",\n";
  AppendNames("bodies", NamesOf(robot, MovingLinks(robot, RobotOrder::kDepthFirst)), &json);
  WriteFileAtomically(NamesFile(file), json + "\n}\n");
}

std::optional<double> RateOf(const RobotExportOptions& options, double own) {
  if (options.rate && !IsExportRate(*options.rate)) {
    throw Error(fmt::format("the rate {:g} Hz is not between 0 and 1000", *options.rate));
  }
  if (options.rate) return options.rate;
  return own > 0 ? std::optional<double>(own) : std::nullopt;
}

RobotMotion DepthFirst(const Robot& robot, const PoseTrajectory& trajectory,
                       std::optional<double> rate) {
  return MakeRobotMotion(robot, trajectory, rate, RobotOrder::kDepthFirst);
}

void WriteLafan(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
                const RobotExportOptions& options) {
  const RobotMotion motion = DepthFirst(robot, trajectory, RateOf(options, kLafanRate));
  const Eigen::MatrixXd quaternions = ScalarLast(motion.root_quaternions);
  std::string csv;
  for (Eigen::Index k = 0; k < motion.num_frames(); ++k) {
    Eigen::VectorXd row(7 + motion.joint_positions.rows());
    row << motion.root_positions.col(k), quaternions.col(k), motion.joint_positions.col(k);
    for (Eigen::Index i = 0; i < row.size(); ++i) {
      csv += fmt::format("{}{:.9f}", i == 0 ? "" : ",", row[i]);
    }
    csv += '\n';
  }
  WriteNames(file, robot, motion, "xyzw");
  WriteFileAtomically(file, csv);
}

void WriteGmr(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
              const RobotExportOptions& options) {
  const std::optional<double> rate = RateOf(options, 0);
  const RobotMotion motion = DepthFirst(robot, trajectory, rate);
  const LinkPoses poses = MakeLinkPoses(robot, trajectory, rate, AllLinks(robot), true);
  const auto bodies = static_cast<std::int64_t>(poses.names.size());
  WriteFileAtomically(file, FormatPickle({PickleValue::Dict{
                                {"fps", {motion.rate}},
                                {"root_pos", {Array("", motion.root_positions)}},
                                {"root_rot", {Array("", ScalarLast(motion.root_quaternions))}},
                                {"dof_pos", {Array("", motion.joint_positions)}},
                                {"local_body_pos", {Array("", poses.positions, {bodies, 3})}},
                                {"link_body_list", {poses.names}},
                                {"joint_names", {motion.joints}}}}));
}

/// xyz, wxyz where the root floats, joints.
Eigen::MatrixXd QPos(const RobotMotion& motion) {
  if (motion.is_root_fixed) return motion.joint_positions;
  Eigen::MatrixXd qpos(7 + motion.joint_positions.rows(), motion.num_frames());
  qpos << motion.root_positions, motion.root_quaternions, motion.joint_positions;
  return qpos;
}

/// As MuJoCo has it: the root's velocity in W, its angular velocity in its own frame.
Eigen::MatrixXd QVel(const RobotMotion& motion) {
  if (motion.is_root_fixed) return motion.joint_velocities;
  Eigen::MatrixXd own = motion.root_angular_velocities;
  for (Eigen::Index k = 0; k < own.cols(); ++k) {
    const Eigen::Vector4d q = motion.root_quaternions.col(k);
    own.col(k) = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).conjugate() * own.col(k).eval();
  }
  Eigen::MatrixXd qvel(6 + motion.joint_velocities.rows(), motion.num_frames());
  qvel << motion.root_velocities, own, motion.joint_velocities;
  return qvel;
}

void Append(const Eigen::MatrixXd& rows, Eigen::MatrixXd* all) {
  all->conservativeResize(all->rows() + rows.rows(), Eigen::NoChange);
  all->bottomRows(rows.rows()) = rows;
}

/// Objects behind the robot, each with a free joint.
void WriteMujoco(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
                 const RobotExportOptions& options) {
  const std::optional<double> rate = RateOf(options, 0);
  const RobotMotion motion = DepthFirst(robot, trajectory, rate);
  Eigen::MatrixXd qpos = QPos(motion), qvel = QVel(motion);
  for (const PoseTrajectory& poses : options.objects) {
    const RobotMotion object = MakeObjectMotion(poses, rate);
    Append(QPos(object).leftCols(qpos.cols()), &qpos);
    Append(QVel(object).leftCols(qvel.cols()), &qvel);
  }
  std::vector<NpyArray> arrays = {Array("qpos", qpos), Array("qvel", qvel),
                                  Number("fps", motion.rate), Texts("joint_names", motion.joints)};
  if (!options.objects.empty()) arrays.push_back(Texts("object_names", options.object_names));
  WriteFileAtomically(file, FormatNpz(arrays));
}

void WriteLocoMujoco(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
                     const RobotExportOptions& options) {
  const RobotMotion motion = DepthFirst(robot, trajectory, RateOf(options, 0));
  std::vector<std::string> names;
  std::vector<std::int64_t> types;
  if (!motion.is_root_fixed) {
    names.emplace_back("root");
    types.push_back(kJointFree);
  }
  for (const int s : motion.joint_segments) {
    const Segment& segment = robot.model.segments()[static_cast<std::size_t>(s)];
    names.push_back(segment.name);
    types.push_back(segment.type == JointType::kSliding ? kJointSlide : kJointHinge);
  }
  const auto count = static_cast<std::int64_t>(types.size());
  WriteFileAtomically(
      file, FormatNpz({Array("qpos", QPos(motion)), Array("qvel", QVel(motion)),
                       Number("frequency", motion.rate), Texts("joint_names", names),
                       Integers("njnt", {}, {count}), Integers("jnt_type", {count}, types),
                       Integers("split_points", {2}, {0, motion.num_frames()})}));
}

void WriteMimic(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
                const std::optional<double>& rate, RobotOrder order) {
  const RobotMotion motion = MakeRobotMotion(robot, trajectory, rate, order);
  const LinkPoses poses = MakeLinkPoses(robot, trajectory, rate, MovingLinks(robot, order), false);
  const auto n = static_cast<std::int64_t>(poses.names.size());
  WriteFileAtomically(file, FormatNpz({{"fps", {1}, {motion.rate}, {}},
                                       Array("joint_pos", motion.joint_positions),
                                       Array("joint_vel", motion.joint_velocities),
                                       Array("body_pos_w", poses.positions, {n, 3}),
                                       Array("body_quat_w", poses.quaternions, {n, 4}),
                                       Array("body_lin_vel_w", poses.velocities, {n, 3}),
                                       Array("body_ang_vel_w", poses.angular_velocities, {n, 3}),
                                       Texts("joint_names", motion.joints),
                                       Texts("body_names", poses.names)}));
}

void WriteBeyondMimic(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
                      const RobotExportOptions& options) {
  if (!options.order) {
    throw Error(
        fmt::format("{}: needs the order of joints and bodies, isaac or mujoco: a wrong one "
                    "trains without a word",
                    file));
  }
  WriteMimic(file, robot, trajectory, RateOf(options, kMimicRate), *options.order);
}

void WriteMjlab(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
                const RobotExportOptions& options) {
  WriteMimic(file, robot, trajectory, RateOf(options, kMimicRate), RobotOrder::kDepthFirst);
}

/// Rotation vectors of the root and of each joint about its axis.
Eigen::MatrixXd PoseVectors(const Robot& robot, const RobotMotion& motion) {
  const auto num_joints = static_cast<Eigen::Index>(motion.joint_segments.size());
  Eigen::MatrixXd vectors(3 + 3 * num_joints, motion.num_frames());
  for (Eigen::Index k = 0; k < motion.num_frames(); ++k) {
    const Eigen::Vector4d q = motion.root_quaternions.col(k);
    vectors.col(k).head<3>() = Log(Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
    for (Eigen::Index i = 0; i < num_joints; ++i) {
      const int s = motion.joint_segments[static_cast<std::size_t>(i)];
      const Segment& joint = robot.model.segments()[static_cast<std::size_t>(s)];
      vectors.col(k).segment<3>(3 + 3 * i) = motion.joint_positions(i, k) * joint.axis;
    }
  }
  return vectors;
}

void CheckPhc(const Robot& robot, const RobotExportOptions& options) {
  const double rate = options.rate.value_or(kLafanRate);
  if (rate != std::round(rate)) {
    throw Error(fmt::format("a file of PHC has whole rates only; {:g} Hz is none", rate));
  }
  for (int j = 0; j < robot.model.num_joints(); ++j) {
    const Segment& joint = robot.model.joint(j);
    if (joint.type != JointType::kSliding) continue;
    throw Error(fmt::format("{} slides; a file of PHC has joints that turn only", joint.name));
  }
}

void WritePhc(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
              const RobotExportOptions& options) {
  CheckPhc(robot, options);
  const RobotMotion motion = DepthFirst(robot, trajectory, RateOf(options, kLafanRate));
  const Eigen::MatrixXd vectors = PoseVectors(robot, motion);
  WriteNames(file, robot, motion, "xyzw");
  WriteFileAtomically(
      file,
      FormatPickle({PickleValue::Dict{
          {options.motion_name,
           {PickleValue::Dict{{"root_trans_offset", {Array("", motion.root_positions)}},
                              {"pose_aa", {Array("", vectors, {vectors.rows() / 3, 3})}},
                              {"dof", {Array("", motion.joint_positions)}},
                              {"root_rot", {Array("", ScalarLast(motion.root_quaternions))}},
                              {"fps", {static_cast<std::int64_t>(std::lround(motion.rate))}}}}}}}));
}

}  // namespace

const std::vector<RobotExporter>& RobotExporters() {
  static const std::vector<RobotExporter> exporters = {
      {"lafan1", "export-lafan1", "csv",
       "root and joints as Unitree's LAFAN1 files have them (CSV without a header; x y z, qx qy qz "
       "qw, joints), 30 Hz; names beside it",
       false, true, WriteLafan, nullptr, kLafanRate},
      {"gmr", "export-gmr", "pkl", "root, joints and bodies as GMR and TWIST have them (pickle)",
       false, false, WriteGmr},
      {"mujoco", "export-mujoco", "npz",
       "qpos and qvel of MuJoCo, of the robot and of objects, each on a free joint behind it "
       "(NumPy; holosoma reads it as a retargeted motion, the last 7 of qpos as its object)",
       false, false, WriteMujoco},
      {"locomujoco", "export-locomujoco", "npz", "a trajectory of LocoMuJoCo (NumPy)", false, false,
       WriteLocoMujoco},
      {"beyondmimic", "export-beyondmimic", "npz",
       "joints and bodies that move, with velocities, as BeyondMimic has them (NumPy), 50 Hz; "
       "needs the order",
       true, false, WriteBeyondMimic, nullptr, kMimicRate},
      {"mjlab", "export-mjlab", "npz",
       "the same as mjlab has them, in MuJoCo's order (NumPy), 50 Hz", false, false, WriteMjlab,
       nullptr, kMimicRate},
      {"phc", "export-phc", "pkl",
       "root, joints and their rotation vectors as PHC and ASAP have them (a pickle that joblib "
       "reads), 30 Hz; names beside it",
       false, true, WritePhc, CheckPhc, kLafanRate}};
  return exporters;
}

std::vector<std::string> FilesOf(const RobotExporter& exporter, const std::string& file) {
  std::vector<std::string> files = {file};
  if (exporter.has_names) files.push_back(NamesFile(file));
  return files;
}

const RobotExporter& FindRobotExporter(const std::string& name) {
  std::vector<std::string> names;
  names.reserve(RobotExporters().size());
  for (const RobotExporter& one : RobotExporters()) {
    if (one.name == name) return one;
    names.emplace_back(one.name);
  }
  throw Error(fmt::format("\"{}\" is no format of robots' motions; there are {}", name,
                          JoinNames(names, ", ")));
}

RobotOrder ParseRobotOrder(const std::string& text) {
  if (text == "isaac") return RobotOrder::kBreadthFirst;
  if (text == "mujoco") return RobotOrder::kDepthFirst;
  throw Error(fmt::format("\"{}\" is no order of joints; use isaac or mujoco", text));
}

}  // namespace mmm_converter
