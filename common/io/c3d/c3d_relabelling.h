// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_events.h"

namespace mmm_converter {

class C3dFile;

/// Frames [begin, end), counted from 0, that are stored for a point of the input.
struct C3dStretch {
  int begin = 0, end = 0;
  int point = 0;  ///< of the input
};

/// A point of a C3D file that is made of another's points.
struct C3dRelabelledPoint {
  std::string label;
  int like = 0;  ///< the input's point whose description it keeps, and its label where it is called
                 ///< as C3dPointNames calls that
  std::vector<C3dStretch> stretches;  ///< in order, without overlaps; elsewhere it is not seen
};

/// Writes the C3D file `input` with other points. A stretch has the stored words of its point, with
/// residual and cameras; where a point has none it is marked invalid. All else stays byte for byte:
/// analog samples, events, parameters and their order, the blocks behind the data. Only these
/// change where they have to: POINT:LABELS and DESCRIPTIONS (and ...2, ...3), the number of points
/// in header and POINT:USED, and, where the parameters need more blocks, all that says in which
/// block something begins. The output may be the input; it appears whole or not at all.
/// @throws Error as C3dFile, and where the format can't hold the points (none or more than 65535,
///         labels of more than 127 bytes, more than 255 blocks of parameters), parameters do
///         not stand between header and data, or the output can't be written.
void WriteRelabelledC3d(const std::string& input, const std::vector<C3dRelabelledPoint>& points,
                        const std::string& output);

/// The same with all points as they are and these events in the group EVENT, in place of its own;
/// those of the header stay. @throws Error as WriteRelabelledC3d, and for more than 255 events.
void WriteC3dWithEvents(const std::string& input, const std::vector<C3dEvent>& events,
                        const std::string& output);

/// What points that are computed from markers hold; POINT lists them as ANGLES, MOMENTS, POWERS.
enum class C3dResultKind { kAngle, kMoment, kPower };

/// Three values for each frame, stored as a point is, as gait laboratories have joint angles.
struct C3dResult {
  std::string label;
  C3dResultKind kind = C3dResultKind::kAngle;
  int first_frame = 0;      ///< of the file, counted from 0; it may lie before the file's
  Eigen::Matrix3Xd values;  ///< a column a frame [deg, N m/kg or W/kg]; NaN: not known
};

/// As WriteC3dWithEvents, with results behind the points and in POINT's list of their kind. Units
/// are those that the file states (ANGLE_UNITS and so on), else deg, Nmm/kg and W/kg. A label that
/// the file has is written with "_MMM" behind it.
/// @throws Error as WriteC3dWithEvents, and where the file's 16 bit integers can't hold a value.
void WriteC3dWithResults(const std::string& input, const std::vector<C3dResult>& results,
                         const std::vector<C3dEvent>& events, const std::string& output);
/// Frames in which a result is beyond what the file's 16 bit integers hold are then not known;
/// which these are: "LKneeMoment in 3 frames". Files that store floats hold all.
std::vector<std::string> HideUnstorable(const C3dFile& file, std::vector<C3dResult>* results);
/// @throws Error where WriteC3dWithResults can't hold these; no results: where WriteC3dWithEvents
/// can't.
void CheckC3dResults(const std::string& input, const std::vector<C3dResult>& results,
                     const std::vector<C3dEvent>& events);

}  // namespace mmm_converter
