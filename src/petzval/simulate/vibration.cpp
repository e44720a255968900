// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/parallel.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/numeric/random.h>
#include <petzval/simulate/vibration.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace petzval {

namespace {

using Line = VibrationSpectrum::Line;
using Density = double Line::*;

/// The integral of a density between two frequencies.
double power(const std::vector<Line>& lines, Density density, double from_hz, double to_hz) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    const Line &a = lines[i], &b = lines[i + 1];
    const double from = std::max(from_hz, a.frequency_hz), to = std::min(to_hz, b.frequency_hz);
    if (!(to > from)) continue;
    const auto at = [&](double hz) {
      return std::lerp(a.*density, b.*density, (hz - a.frequency_hz) / (b.frequency_hz - a.frequency_hz));
    };
    sum += (at(from) + at(to)) / 2 * (to - from);
  }
  return sum;
}

struct Wave {
  double amplitude_deg, radians_per_s, phase;
};

std::vector<Wave> waves_of(const std::vector<Line>& lines, Density density, RandomStream random) {
  constexpr int count = 256;
  const double first = lines.front().frequency_hz, step = (lines.back().frequency_hz - first) / count;
  std::vector<Wave> waves;
  for (int i = 0; i < count; ++i) {
    const double from = first + i * step;
    const double frequency = from + step * random.uniform(), phase = 2 * pi * random.uniform();
    const double deg2 = power(lines, density, from, from + step);
    if (deg2 > 0) waves.push_back({std::sqrt(2 * deg2), 2 * pi * frequency, phase});
  }
  return waves;
}

double sum_at(const std::vector<Wave>& waves, double t_s) {
  double sum = 0;
  for (const Wave& wave : waves) sum += wave.amplitude_deg * std::cos(wave.radians_per_s * t_s + wave.phase);
  return sum;
}

/// "0.02@1-20"
std::optional<VibrationSpectrum> flat(const std::string& text) {
  const std::size_t at = text.find('@'), dash = text.find('-', at == text.npos ? 0 : at);
  if (at == text.npos || dash == text.npos) return {};
  const auto rms = parse_number(text.substr(0, at)), from = parse_number(text.substr(at + 1, dash - at - 1)),
             to = parse_number(text.substr(dash + 1));
  if (!rms || !from || !to || !(*rms > 0) || !(*from >= 0) || !(*to > *from)) return {};
  const double density = *rms * *rms / (*to - *from);
  return VibrationSpectrum({{*from, density, density}, {*to, density, density}});
}

VibrationSpectrum read_spectrum(const std::string& path) {
  constexpr std::size_t most_bytes = std::size_t{1} << 26;
  constexpr std::pair<const char*, Density> known[] = {{"frequency_hz", &Line::frequency_hz},
                                                       {"pan_deg2_per_hz", &Line::pan_deg2_per_hz},
                                                       {"pitch_deg2_per_hz", &Line::pitch_deg2_per_hz}};
  std::vector<Density> columns;
  std::vector<Line> lines;
  for (const TextLine& text : text_lines(read_whole_file(path, most_bytes))) {
    if (trimmed(text.text).empty()) continue;
    const std::vector<std::string> cells = split_at(text.text, ',');
    if (columns.empty()) {
      for (const std::string& cell : cells) {
        const auto found = std::ranges::find(known, trimmed(cell),
                                             [](const auto& entry) { return std::string(entry.first); });
        if (found == std::end(known))
          throw InputError(path, text.number,
                           fmt::format("a column \"{}\"; frequency_hz, pan_deg2_per_hz and "
                                       "pitch_deg2_per_hz would be right",
                                       quotable(cell)));
        columns.push_back(found->second);
      }
      if (std::ranges::count(columns, known[0].second) != 1)
        throw InputError(path, text.number, "one column of frequencies, frequency_hz, must be there");
      continue;
    }
    if (cells.size() != columns.size())
      throw InputError(path, text.number,
                       fmt::format("has {} numbers for {} columns", cells.size(), columns.size()));
    Line& line = lines.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::optional<double> value = parse_number(trimmed(cells[i]));
      if (!value)
        throw InputError(path, text.number, fmt::format("\"{}\" is not a number", quotable(cells[i])));
      line.*columns[i] = *value;
    }
  }
  try {
    return VibrationSpectrum(std::move(lines));
  } catch (const InputError& error) {
    throw InputError(path, error.what());
  }
}

}  // namespace

VibrationSpectrum::VibrationSpectrum(std::vector<Line> lines) : lines_(std::move(lines)) {
  if (lines_.size() < 2) throw InputError("a spectrum of vibration needs two frequencies at least");
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    for (const double value : {line.frequency_hz, line.pan_deg2_per_hz, line.pitch_deg2_per_hz})
      if (!(std::isfinite(value) && value >= 0))
        throw InputError("a spectrum of vibration must be of finite numbers that are not negative");
    if (i > 0 && !(line.frequency_hz > lines_[i - 1].frequency_hz))
      throw InputError(fmt::format("the frequencies of a spectrum must increase; {:g} Hz follows {:g} Hz",
                                   line.frequency_hz, lines_[i - 1].frequency_hz));
  }
}

VibrationSpectrum VibrationSpectrum::parse(const std::string& text) {
  if (std::optional<VibrationSpectrum> spectrum = flat(text)) return *std::move(spectrum);
  if (text.ends_with(".csv")) return read_spectrum(text);
  throw InputError(fmt::format(
      "a vibration of {}; 0.02@1-20 (degrees rms, from and to Hz) or a .csv would be right", quotable(text)));
}

double VibrationSpectrum::rms_pan_deg() const {
  return std::sqrt(power(lines_, &Line::pan_deg2_per_hz, 0, INFINITY));
}

double VibrationSpectrum::rms_pitch_deg() const {
  return std::sqrt(power(lines_, &Line::pitch_deg2_per_hz, 0, INFINITY));
}

MotionPath VibrationSpectrum::shaken(const MotionPath& path, double duration_s, std::uint64_t seed) const {
  constexpr double a_period = 16, most = 4e6;
  const double count = std::ceil(duration_s * a_period * lines_.back().frequency_hz);
  if (!(count <= most))
    throw InputError(
        fmt::format("a vibration up to {:g} Hz for {:g} s has more than 4 million instants; a "
                    "shorter clip, or lower frequencies, would be right",
                    lines_.back().frequency_hz, duration_s));
  std::vector<double> at;
  for (double i = 0; i <= count; ++i) at.push_back(duration_s * i / count);
  for (const MotionPath::Key& key : path.keys())
    if (key.t_s > 0 && key.t_s < duration_s) at.push_back(key.t_s);
  std::ranges::sort(at);
  at.erase(std::unique(at.begin(), at.end()), at.end());

  enum Purpose : std::uint32_t { of_pan = 128, of_pitch = 129 };  // beyond those of capture()
  const std::vector<Wave> pan = waves_of(lines_, &Line::pan_deg2_per_hz, RandomStream(seed, of_pan, 0)),
                          pitch = waves_of(lines_, &Line::pitch_deg2_per_hz, RandomStream(seed, of_pitch, 0));
  std::vector<MotionPath::Key> keys(at.size());
  parallel_for(at.size(), [&](std::size_t i) {
    keys[i] = {at[i], path.at(at[i])};
    keys[i].aim.pan_deg += sum_at(pan, at[i]);
    keys[i].aim.pitch_deg += sum_at(pitch, at[i]);
  });
  return MotionPath(std::move(keys));
}

}  // namespace petzval
