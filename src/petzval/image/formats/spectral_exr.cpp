// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/text_lines.h>
#include <petzval/image/formats/exr_input.h>
#include <petzval/image/formats/exr_stream.h>
#include <petzval/image/formats/output_file.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/image/spectral_image.h>

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr const char* version_attribute = "spectralLayoutVersion";
constexpr const char* units_attribute = "emissiveUnits";
constexpr int rows_at_a_time = 256;    // whole blocks of ZIP, which are 16 rows
constexpr double same_band_nm = 1e-6;  // closer bands are one band written in two units

struct Band {
  double wavelength_nm;
  std::string channel;
};

// ---- reading

/// The bands of the file, sorted, and their kind.
std::vector<Band> bands_of(const Imf::ChannelList& channels, SpectralExr& exr, const std::string& path) {
  std::vector<Band> light, reflectance;
  std::string others;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const std::optional<SpectralChannel> parsed = parse_spectral_channel(channel.name());
    if (!parsed)
      others += (others.empty() ? "" : ", ") + std::string(channel.name());
    else if (parsed->stokes == 0)
      (parsed->kind == SpectralExr::Kind::emissive ? light : reflectance)
          .push_back({parsed->wavelength_nm, channel.name()});
    if (parsed && !is_whole(channel.channel()))
      throw InputError(
          path, fmt::format("channel {} is subsampled; every pixel needs a value", quotable(channel.name())));
  }
  exr.kind = light.empty() ? SpectralExr::Kind::reflective : SpectralExr::Kind::emissive;
  exr.also_reflective = !light.empty() && !reflectance.empty();
  std::vector<Band> bands = light.empty() ? reflectance : light;
  if (bands.empty())
    throw InputError(path, fmt::format("has no spectral channels such as S0.550,0nm or T.550,0nm, only {}",
                                       others.empty() ? "polarised ones" : quotable(others)));
  std::sort(bands.begin(), bands.end(),
            [](const Band& a, const Band& b) { return a.wavelength_nm < b.wavelength_nm; });
  for (std::size_t i = 1; i < bands.size(); ++i)
    if (bands[i].wavelength_nm - bands[i - 1].wavelength_nm < same_band_nm)
      throw InputError(path, fmt::format("has the wavelength {} nm twice: {} and {}", bands[i].wavelength_nm,
                                         quotable(bands[i - 1].channel), quotable(bands[i].channel)));
  return bands;
}

void take_attributes(const Imf::Header& header, SpectralExr& exr) {
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
      (name == units_attribute ? exr.units : exr.strings[name]) = text->value();
    else if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(&it.attribute()))
      exr.numbers[name] = real->value();
    else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&it.attribute()))
      exr.numbers[name] = static_cast<double>(single->value());
    else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&it.attribute()))
      exr.numbers[name] = integer->value();
  }
  // These belong to the container, or are written anew.
  for (const char* name : {"pixelAspectRatio", "screenWindowWidth", "chunkCount"}) exr.numbers.erase(name);
  for (const char* name : {"name", "type", version_attribute}) exr.strings.erase(name);
}

void read_pixels(Imf::InputFile& file, const std::vector<Band>& bands, const SpectralPlanes& planes,
                 SpectralExr& exr) {
  const ExrWindow window(file.header());
  Imf::FrameBuffer buffer;
  for (std::size_t i = 0; i < bands.size(); ++i)
    buffer.insert(bands[i].channel, window.plane(planes.bands[i].data()));
  for (const auto& [name, plane] :
       {std::pair{exr_depth_channel, &exr.depth}, std::pair{exr_lamps_channel, &exr.lamps}})
    if (const Imf::Channel* channel = file.header().channels().findChannel(name);
        channel != nullptr && is_whole(*channel)) {
      plane->resize(exr.band_size());
      buffer.insert(name, window.plane(plane->data()));
    }
  file.setFrameBuffer(buffer);
  for (int row = window.box.min.y; row <= window.box.max.y; row += rows_at_a_time) {
    const int last = std::min(row + rows_at_a_time - 1, window.box.max.y);
    file.readPixels(row, last);
    if (planes.after_rows) planes.after_rows(row - window.box.min.y, last + 1 - window.box.min.y);
  }
}

/// Threads for compression beside our own; 0 works in ours alone. The bytes do not depend on it.
int compression_threads() {
  const int threads = thread_count() > 1 ? thread_count() : 0;
  Imf::setGlobalThreadCount(threads);
  return threads;
}

SpectralExr read_spectra(const std::string& path, const std::function<SpectralPlanes(SpectralExr&)>& place) {
  Imf::InputFile file(path.c_str(), compression_threads());
  SpectralExr exr;
  const std::vector<Band> bands = bands_of(file.header().channels(), exr, path);
  for (const Band& band : bands) exr.wavelengths_nm.push_back(band.wavelength_nm);
  const ExrWindow window(file.header());
  exr.width = window.columns;
  exr.height = window.rows;
  if (bands.size() > SpectralImage::max_values / exr.band_size())
    throw InputError(path, fmt::format("{} x {} pixels in {} bands are more than can be held", exr.width,
                                       exr.height, bands.size()));
  take_attributes(file.header(), exr);
  read_pixels(file, bands, place(exr), exr);
  return exr;
}

// ---- writing

/// Those that are no bands.
std::vector<ExrPlane> planes_beside(const SpectralExr& exr) {
  std::vector<ExrPlane> planes = exr.others;
  if (!exr.depth.empty()) planes.push_back({exr_depth_channel, exr.depth});
  if (!exr.lamps.empty()) planes.push_back({exr_lamps_channel, exr.lamps});
  return planes;
}

void check(const std::string& path, const SpectralExr& exr, std::span<const float> values) {
  if (exr.width < 1 || exr.height < 1 || exr.wavelengths_nm.empty())
    throw InputError(path, "an image needs at least one pixel and one wavelength");
  if (values.size() != exr.band_size() * exr.wavelengths_nm.size())
    throw InputError(path, fmt::format("{} values for {} x {} pixels in {} bands", values.size(), exr.width,
                                       exr.height, exr.wavelengths_nm.size()));
  for (const ExrPlane& plane : planes_beside(exr))
    if (plane.values.size() != exr.band_size())
      throw InputError(path, fmt::format("{} values in channel {} for {} x {} pixels", plane.values.size(),
                                         plane.name, exr.width, exr.height));
  for (std::size_t i = 0; i < exr.wavelengths_nm.size(); ++i)
    if (!(exr.wavelengths_nm[i] > 0) || std::isinf(exr.wavelengths_nm[i]) ||
        (i > 0 && exr.wavelengths_nm[i] - exr.wavelengths_nm[i - 1] < same_band_nm))
      throw InputError(
          path, fmt::format("the wavelengths of an image must be positive and increase; {} nm does not",
                            exr.wavelengths_nm[i]));
}

Imf::Header header_of(const SpectralExr& exr) {
  Imf::Header header(exr.width, exr.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  // As small as with zlib's own level, 6, in two thirds of the time: there is little to find in floats.
  constexpr int zip_level = 2;
  header.zipCompressionLevel() = zip_level;
  header.insert(version_attribute, Imf::StringAttribute("1.0"));
  if (!exr.units.empty()) header.insert(units_attribute, Imf::StringAttribute(exr.units));
  for (const auto& [name, text] : exr.strings) header.insert(name, Imf::StringAttribute(text));
  for (const auto& [name, number] : exr.numbers) header.insert(name, Imf::DoubleAttribute(number));
  return header;
}

void write(OutputFile& output, const SpectralExr& exr, std::span<const float> values,
           const std::function<void()>& after_rows) {
  Imf::Header header = header_of(exr);
  Imf::FrameBuffer buffer;
  std::vector<ExrPlane> planes = planes_beside(exr);
  for (std::size_t i = 0; i < exr.wavelengths_nm.size(); ++i)
    planes.push_back({spectral_channel_name({exr.kind, 0, exr.wavelengths_nm[i]}),
                      values.subspan(i * exr.band_size(), exr.band_size())});
  for (const ExrPlane& plane : planes) {
    header.channels().insert(plane.name, Imf::Channel(Imf::FLOAT));
    // The library takes non-const memory for reading and for writing alike; a writer only reads it.
    auto* first = reinterpret_cast<char*>(const_cast<float*>(plane.values.data()));
    buffer.insert(plane.name, Imf::Slice(Imf::FLOAT, first, sizeof(float),
                                         sizeof(float) * static_cast<std::size_t>(exr.width)));
  }
  ExrStream stream(output);
  try {
    Imf::OutputFile file(stream, header, compression_threads());
    file.setFrameBuffer(buffer);
    for (int row = 0; row < exr.height; row += rows_at_a_time) {
      file.writePixels(std::min(rows_at_a_time, exr.height - row));
      if (after_rows) after_rows();
    }
  } catch (...) {
    stream.rethrow();
    throw;
  }
  stream.rethrow();
}

}  // namespace

void SpectralExr::validate(const std::string& file) const {
  for (std::size_t index = 0; index < wavelengths_nm.size(); ++index) {
    const std::span<const float> values_of_band = plane(index);
    const auto bad = std::find_if(values_of_band.begin(), values_of_band.end(),
                                  [](float value) { return !std::isfinite(value); });
    values.release_memory();
    if (bad == values_of_band.end()) continue;
    const auto at = static_cast<std::size_t>(bad - values_of_band.begin());
    const auto columns = static_cast<std::size_t>(width);
    throw InputError(file, fmt::format("the value at {} nm, row {}, column {} is {}; it must be finite",
                                       wavelengths_nm[index], at / columns, at % columns, *bad));
  }
}

SpectralExr read_spectral_exr(const std::string& path, const std::function<void(const SpectralExr&)>& check) {
  return reading_exr(path, [&check](const std::string& file) {
    return read_spectra(file, [&check](SpectralExr& exr) {
      if (check) check(exr);
      exr.values = LargeFloats(exr.band_size() * exr.wavelengths_nm.size());
      SpectralPlanes planes;
      for (std::size_t i = 0; i < exr.wavelengths_nm.size(); ++i) planes.bands.push_back(exr.plane(i));
      planes.after_rows = [&exr](int, int) { exr.values.release_memory(); };
      return planes;
    });
  });
}

SpectralExr read_spectral_exr_into(const std::string& path,
                                   const std::function<SpectralPlanes(const SpectralExr&)>& place) {
  return reading_exr(path, [&place](const std::string& file) { return read_spectra(file, place); });
}

void write_spectral_exr(const std::string& path, const SpectralExr& exr) {
  write_spectral_exr(path, exr, exr.values.all(), {});
}

void write_spectral_exr(const std::string& path, const SpectralExr& exr, std::span<const float> values,
                        const std::function<void()>& after_rows) {
  check(path, exr, values);
  OutputFile output(path);
  try {
    write(output, exr, values, after_rows);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Failure(fmt::format("{}: cannot be written: {}", path, error.what()));
  }
  output.commit();
}

}  // namespace petzval
