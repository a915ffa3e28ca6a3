// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_analog.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace mmm_converter {
namespace {

constexpr std::size_t kMostPlates = 255;  // a dimension of a parameter
constexpr std::size_t kCornerNumbers = 12;
constexpr std::size_t kOriginNumbers = 3;
constexpr std::size_t kCalibrationNumbers = 36;
constexpr std::size_t kPolynomialNumbers = 12;
constexpr std::size_t kZeroNumbers = 2;

double AnalogRate(const C3dFile& file, int samples_per_frame) {
  const double stated = file.parameters().Number("ANALOG", "RATE").value_or(0);
  if (std::isfinite(stated) && stated > 0) return stated;
  return file.layout().rate * samples_per_frame;
}

/// The numbers of one plate in a parameter that has `per_plate` for each.
std::vector<double> NumbersOf(const C3dParameter* parameter, std::size_t plate,
                              std::size_t per_plate) {
  std::vector<double> numbers;
  for (std::size_t i = 0; parameter != nullptr && i < per_plate; ++i) {
    const std::optional<double> number = parameter->Number(plate * per_plate + i);
    if (!number) break;
    numbers.push_back(*number);
  }
  return numbers;
}

/// Words that are stored, and offsets, count from 0 on.
bool IsUnsigned(const C3dParameters& parameters) {
  return parameters.Text("ANALOG", "FORMAT") == "UNSIGNED";
}

/// A number for each channel from ANALOG:NAME, NAME2, ...; `usual` where the file says nothing.
Eigen::VectorXd NumberOfEach(const C3dParameters& parameters, const std::string& name,
                             Eigen::Index channels, double usual) {
  Eigen::VectorXd numbers = Eigen::VectorXd::Constant(channels, usual);
  Eigen::Index channel = 0;
  for (int i = 1; channel < channels; ++i) {
    const C3dParameter* const parameter =
        parameters.Find("ANALOG", i == 1 ? name : fmt::format("{}{}", name, i));
    if (parameter == nullptr) break;
    const bool is_signed = parameter->type == 2 && !IsUnsigned(parameters);
    for (std::size_t k = 0; k < parameter->size() && channel < channels; ++k, ++channel) {
      double number = *parameter->Number(k);
      if (is_signed && number > INT16_MAX) number -= UINT16_MAX + 1;
      if (std::isfinite(number)) numbers[channel] = number;
    }
  }
  return numbers;
}

/// As they are stored.
void DecodeSamples(const unsigned char* stored, const C3dLayout& layout, bool is_unsigned,
                   std::span<double> samples) {
  for (double& sample : samples) {
    if (layout.floats) {
      sample = C3dFloat(stored, layout.processor);
      stored += 4;
    } else {
      const std::uint16_t word = C3dWord(stored, layout.processor);
      sample = is_unsigned ? word : static_cast<std::int16_t>(word);
      stored += 2;
    }
  }
}

}  // namespace

C3dAnalog ReadC3dAnalog(const C3dFile& file, Warnings* warnings) {
  const C3dParameters& parameters = file.parameters();
  const int words = file.layout().analog_words;
  C3dAnalog analog;
  if (words == 0) return analog;
  int samples = std::max(file.header().analog_samples, 1);
  const double used_number = parameters.Number("ANALOG", "USED").value_or(0);
  const int used = used_number >= 1 && used_number <= 65535 ? static_cast<int>(used_number) : 0;
  if (words != file.header().analog_words && used > 0 && words % used == 0) samples = words / used;
  if (words % samples != 0) {
    const int by_used = used > 0 && words % used == 0 ? words / used : 1;
    Warn(warnings, fmt::format("the header says {} analog samples of each channel in a frame, but "
                               "{} of all; read as {}",
                               samples, words, by_used));
    samples = by_used;
  }
  analog.samples_per_frame = samples;
  analog.rate = AnalogRate(file, samples);
  analog.channels.resize(static_cast<std::size_t>(words / samples));
  if (used != 0 && used != words / samples) {
    Warn(warnings,
         fmt::format("the header says {} analog channels, ANALOG:USED {}", words / samples, used));
  }
  const std::size_t most = analog.channels.size();
  const std::vector<std::string> labels = parameters.TextList("ANALOG", "LABELS", most);
  const std::vector<std::string> units = parameters.TextList("ANALOG", "UNITS", most);
  const std::vector<std::string> descriptions = parameters.TextList("ANALOG", "DESCRIPTIONS", most);
  for (std::size_t i = 0; i < analog.channels.size(); ++i) {
    C3dAnalogChannel& channel = analog.channels[i];
    if (i < labels.size()) channel.label = labels[i];
    if (channel.label.empty()) channel.label = fmt::format("*{}", i + 1);
    if (i < units.size()) channel.unit = units[i];
    if (i < descriptions.size()) channel.description = descriptions[i];
  }
  return analog;
}

Eigen::MatrixXd ReadC3dAnalogSamples(C3dFile* file, const C3dAnalog& analog) {
  const C3dLayout& layout = file->layout();
  const auto channels = static_cast<Eigen::Index>(analog.channels.size());
  const Eigen::Index words = channels * analog.samples_per_frame;
  Eigen::MatrixXd samples(channels, Eigen::Index{layout.frames} * analog.samples_per_frame);
  if (samples.size() == 0) return samples;
  const C3dParameters& parameters = file->parameters();
  const bool is_unsigned = IsUnsigned(parameters);
  const std::size_t behind_points =
      static_cast<std::size_t>(layout.points) * (layout.floats ? 16 : 8);
  file->ReadAllFrames([&](int first, int count, const unsigned char* stored) {
    for (int i = 0; i < count; ++i) {
      DecodeSamples(stored + i * layout.frame_bytes + behind_points, layout, is_unsigned,
                    {samples.data() + (first + i) * words, static_cast<std::size_t>(words)});
    }
  });
  const double scale = NumberOfEach(parameters, "GEN_SCALE", 1, 1)[0];
  samples.colwise() -= NumberOfEach(parameters, "OFFSET", channels, 0);
  const Eigen::VectorXd scales = scale * NumberOfEach(parameters, "SCALE", channels, 1);
  samples.array().colwise() *= scales.array();
  return samples;
}

std::vector<C3dForcePlate> ReadC3dForcePlates(const C3dParameters& parameters, Warnings* warnings) {
  const C3dParameter* types = parameters.Find("FORCE_PLATFORM", "TYPE");
  const C3dParameter* corners = parameters.Find("FORCE_PLATFORM", "CORNERS");
  const C3dParameter* channels = parameters.Find("FORCE_PLATFORM", "CHANNEL");
  const C3dParameter* origins = parameters.Find("FORCE_PLATFORM", "ORIGIN");
  const std::size_t types_there = types == nullptr ? 0 : types->size();
  const std::size_t corners_there = corners == nullptr ? 0 : corners->size() / kCornerNumbers;
  const std::size_t stored = std::max(types_there, corners_there);
  const double used = parameters.Number("FORCE_PLATFORM", "USED").value_or(0);
  std::vector<C3dForcePlate> plates;
  if (!(used >= 1)) return plates;
  if (used > static_cast<double>(stored)) {
    Warn(warnings,
         fmt::format("FORCE_PLATFORM:USED says {} force plates, type or corners are there of {}",
                     used, stored));
  }
  plates.resize(static_cast<std::size_t>(
      std::min({used, static_cast<double>(stored), static_cast<double>(kMostPlates)})));
  for (std::size_t i = 0; i < plates.size(); ++i) {
    C3dForcePlate& plate = plates[i];
    if (const auto type = types == nullptr ? std::nullopt : types->Number(i)) {
      plate.type = static_cast<int>(std::clamp(*type, -32768.0, 65535.0));
    }
    const std::size_t per_plate =
        channels == nullptr || channels->dimensions.empty() ? 0 : channels->dimensions[0];
    for (const double channel : NumbersOf(channels, i, per_plate)) {
      const bool is_number = channel >= 1 && channel <= 65535;
      plate.channels.push_back(is_number ? static_cast<int>(channel) : 0);
    }
    const std::vector<double> numbers = NumbersOf(corners, i, kCornerNumbers);
    if (numbers.size() == kCornerNumbers) {
      plate.corners = Eigen::Map<const Eigen::Matrix<double, 3, 4>>(numbers.data());
    }
    const std::vector<double> origin = NumbersOf(origins, i, kOriginNumbers);
    if (origin.size() == kOriginNumbers) plate.origin = Eigen::Vector3d(origin.data());
    const std::vector<double> calibration =
        NumbersOf(parameters.Find("FORCE_PLATFORM", "CAL_MATRIX"), i, kCalibrationNumbers);
    if (calibration.size() == kCalibrationNumbers) {
      plate.calibration = Eigen::Map<const Eigen::Matrix<double, 6, 6>>(calibration.data());
    }
    const C3dParameter* const polynomials = parameters.Find("FORCE_PLATFORM", "FPCOPPOLY");
    const std::vector<double> polynomial = NumbersOf(polynomials, i, kPolynomialNumbers);
    if (polynomial.size() == kPolynomialNumbers) {
      const bool is_across = polynomials->dimensions.size() >= 2 &&
                             polynomials->dimensions[0] == 2 && polynomials->dimensions[1] == 6;
      plate.cop_polynomial =
          is_across
              ? Eigen::Matrix<double, 6, 2>(
                    Eigen::Map<const Eigen::Matrix<double, 2, 6>>(polynomial.data()).transpose())
              : Eigen::Matrix<double, 6, 2>(
                    Eigen::Map<const Eigen::Matrix<double, 6, 2>>(polynomial.data()));
    }
  }
  return plates;
}

std::optional<C3dZeroFrames> ReadC3dZeroFrames(const C3dParameters& parameters) {
  const std::vector<double> frames =
      NumbersOf(parameters.Find("FORCE_PLATFORM", "ZERO"), 0, kZeroNumbers);
  if (frames.size() != kZeroNumbers || !(frames[1] >= 1) || frames[0] > frames[1]) return {};
  if (!(frames[0] >= 0) || frames[1] > 65535) return {};
  return C3dZeroFrames{std::max(1, static_cast<int>(frames[0])), static_cast<int>(frames[1])};
}

}  // namespace mmm_converter
