// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/image/formats/exr_stream.h>
#include <petzval/image/formats/output_file.h>
#include <petzval/image/formats/plane_exr.h>

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <new>

namespace petzval {

namespace {

void write(OutputFile& output, const Imf::Header& header, const Imf::FrameBuffer& buffer, int rows) {
  ExrStream stream(output);
  try {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(buffer);
    file.writePixels(rows);
  } catch (...) {
    stream.rethrow();
    throw;
  }
  stream.rethrow();
}

}  // namespace

void write_plane_exr(const std::string& path, int columns, int rows, const std::vector<ExrPlane>& planes,
                     const std::map<std::string, std::string>& strings,
                     const std::map<std::string, double>& numbers) {
  if (columns < 1 || rows < 1 || planes.empty())
    throw InputError(path, "a picture needs at least one pixel and one channel");
  Imf::Header header(columns, rows);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, text] : strings) header.insert(name, Imf::StringAttribute(text));
  for (const auto& [name, number] : numbers) header.insert(name, Imf::DoubleAttribute(number));
  Imf::FrameBuffer buffer;
  const auto width = static_cast<std::size_t>(columns);
  for (const ExrPlane& plane : planes) {
    if (plane.values.size() != width * static_cast<std::size_t>(rows))
      throw InputError(path, fmt::format("{} values in channel {} for {} x {} pixels", plane.values.size(),
                                         plane.name, columns, rows));
    header.channels().insert(plane.name, Imf::Channel(Imf::FLOAT));
    // The library takes non-const memory for reading and for writing alike; a writer only reads it.
    auto* values = reinterpret_cast<char*>(const_cast<float*>(plane.values.data()));
    buffer.insert(plane.name, Imf::Slice(Imf::FLOAT, values, sizeof(float), sizeof(float) * width));
  }
  OutputFile output(path);
  try {
    write(output, header, buffer, rows);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Failure(fmt::format("{}: cannot be written: {}", path, error.what()));
  }
  output.commit();
}

}  // namespace petzval
