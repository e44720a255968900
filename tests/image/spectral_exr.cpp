// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/image/formats/spectral_exr.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>

#include "hostile.h"

namespace petzval {
namespace {

void read_whole_exr(const std::string& path) {
  read_spectral_exr(path);
}

SpectralExr example_cube(int width = 7, int height = 5) {
  SpectralExr exr;
  exr.width = width, exr.height = height;
  exr.wavelengths_nm = {450, 587.56, 1050};  // by name, "S0.1050,0nm" comes first
  exr.units = spectral_radiance_units;
  exr.strings = {{"comments", "made by hand"}};
  exr.numbers = {{"distance_m", 0.1}};
  exr.values = LargeFloats(3 * exr.band_size());
  for (std::size_t i = 0; i < exr.values.size(); ++i) exr.values.all()[i] = 0.1f * static_cast<float>(i);
  return exr;
}

std::string exr_message(const std::string& path) {
  try {
    read_spectral_exr(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SpectralExr, RoundTripsExactly) {
  const test::Scratch scratch;
  for (const auto kind : {SpectralExr::Kind::emissive, SpectralExr::Kind::reflective}) {
    SpectralExr exr = example_cube();
    exr.kind = kind;
    if (kind == SpectralExr::Kind::reflective) exr.units = "";
    write_spectral_exr(scratch.path("a.exr"), exr);
    const SpectralExr back = read_spectral_exr(scratch.path("a.exr"));
    EXPECT_EQ(back.width, 7);
    EXPECT_EQ(back.height, 5);
    EXPECT_EQ(back.kind, kind);
    EXPECT_EQ(back.wavelengths_nm, exr.wavelengths_nm);
    EXPECT_EQ(back.units, exr.units);
    EXPECT_EQ(back.strings, exr.strings);
    EXPECT_EQ(back.numbers, exr.numbers);
    EXPECT_TRUE(std::ranges::equal(back.values.all(), exr.values.all()));
  }
}

TEST(SpectralExr, HasTheNamesOfFichetPacanowskiWilkie2021) {
  const test::Scratch scratch;
  const SpectralExr exr = example_cube();
  write_spectral_exr(scratch.path("a.exr"), exr);
  Imf::InputFile file(scratch.path("a.exr").c_str());
  const auto text = [&](const char* name) {
    return file.header().typedAttribute<Imf::StringAttribute>(name).value();
  };
  EXPECT_EQ(text("spectralLayoutVersion"), "1.0");
  EXPECT_EQ(text("emissiveUnits"), "W.m^-2.sr^-1.nm^-1");
  std::vector<float> plane(exr.band_size());
  Imf::FrameBuffer buffer;
  buffer.insert("S0.587,56nm", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()), 4, 4 * 7));
  file.setFrameBuffer(buffer);
  file.readPixels(0, 4);
  EXPECT_TRUE(std::equal(plane.begin(), plane.end(), exr.plane(1).begin()));
}

TEST(SpectralExr, SameBytesTwiceAndNoTimeInThem) {
  const test::Scratch scratch;
  write_spectral_exr(scratch.path("a.exr"), example_cube());
  write_spectral_exr(scratch.path("b.exr"), example_cube());
  const std::string bytes = read_whole_file(scratch.path("a.exr"));
  EXPECT_EQ(bytes, read_whole_file(scratch.path("b.exr")));
  EXPECT_EQ(bytes.find("capDate"), std::string::npos);
}

// ---- files by other hands, made with the OpenEXR library directly

struct ForeignChannel {
  std::string name;
  Imf::PixelType type = Imf::FLOAT;
};

/// 6 × 4 pixels at an offset; channel c holds 10 c + its position in row order, modulo nothing.
std::string foreign(const test::Scratch& scratch, const std::vector<ForeignChannel>& channels,
                    Imf::Compression compression = Imf::ZIP_COMPRESSION) {
  const Imath::Box2i window({-3, 20}, {2, 23});
  Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
  header.compression() = compression;
  Imf::FrameBuffer buffer;
  std::vector<std::vector<char>> memory;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    header.channels().insert(channels[c].name, Imf::Channel(channels[c].type));
    const std::size_t size = channels[c].type == Imf::HALF ? 2 : 4;
    memory.emplace_back(size * 24);
    for (std::size_t i = 0; i < 24; ++i) {
      const auto number = static_cast<float>(100 * c + i);
      const half half_number = number;
      const auto integer = static_cast<unsigned>(number);
      const void* source = channels[c].type == Imf::HALF    ? static_cast<const void*>(&half_number)
                           : channels[c].type == Imf::FLOAT ? static_cast<const void*>(&number)
                                                            : &integer;
      std::memcpy(memory.back().data() + size * i, source, size);
    }
  }
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::size_t size = channels[c].type == Imf::HALF ? 2 : 4;
    buffer.insert(channels[c].name,
                  Imf::Slice::Make(channels[c].type, memory[c].data(), window, size, 6 * size));
  }
  const std::string path = scratch.path("foreign.exr");
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(4);
  return path;
}

TEST(SpectralExr, ReadsOtherUnitsTypesAndWindowsInOrderOfWavelength) {
  const test::Scratch scratch;
  const SpectralExr exr = read_spectral_exr(foreign(scratch, {{"S0.500,0THz", Imf::HALF},
                                                              {"S0.0,45um", Imf::UINT},
                                                              {"S0.700,000000nm", Imf::FLOAT},
                                                              {"S1.450,0nm", Imf::FLOAT},
                                                              {"T.450,0nm", Imf::FLOAT},
                                                              {"R", Imf::HALF}}));
  ASSERT_EQ(exr.wavelengths_nm.size(), 3u);
  EXPECT_EQ(exr.width, 6);
  EXPECT_EQ(exr.height, 4);
  EXPECT_NEAR(exr.wavelengths_nm[0], 450, 1e-9);
  EXPECT_NEAR(exr.wavelengths_nm[1], 599.584916, 1e-9);
  EXPECT_EQ(exr.wavelengths_nm[2], 700);
  EXPECT_EQ(exr.kind, SpectralExr::Kind::emissive);
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_EQ(exr.plane(0)[i], 100 + static_cast<float>(i));
    EXPECT_EQ(exr.plane(1)[i], static_cast<float>(i));
    EXPECT_EQ(exr.plane(2)[i], 200 + static_cast<float>(i));
  }
}

TEST(SpectralExr, ReadsEveryLosslessCompression) {
  const test::Scratch scratch;
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                             Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    const SpectralExr exr = read_spectral_exr(foreign(scratch, {{"T.450,0nm"}, {"T.500,0nm"}}, compression));
    EXPECT_EQ(exr.kind, SpectralExr::Kind::reflective);
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(exr.plane(1)[i], 100 + static_cast<float>(i));
  }
}

TEST(SpectralExr, ReadsTiles) {
  const test::Scratch scratch;
  const Imath::Box2i window({-1, 2}, {8, 8});  // 10 × 7 in tiles of 4 × 4
  Imf::Header header(window, window);
  header.setTileDescription(Imf::TileDescription(4, 4, Imf::MIPMAP_LEVELS));
  header.channels().insert("T.550,0nm", Imf::Channel(Imf::FLOAT));
  std::vector<float> values(70);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * i);
  {
    Imf::TiledOutputFile file(scratch.path("tiled.exr").c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("T.550,0nm", Imf::Slice::Make(Imf::FLOAT, values.data(), window, 4, 4 * 10));
    file.setFrameBuffer(buffer);
    for (int level = 0; level < file.numLevels(); ++level)
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  }
  EXPECT_TRUE(std::ranges::equal(read_spectral_exr(scratch.path("tiled.exr")).values.all(), values));
  const std::string bytes = read_whole_file(scratch.path("tiled.exr"));
  test::survives_flips(scratch, bytes, 300, read_whole_exr);
}

TEST(SpectralExr, RefusesABandThatIsThereTwice) {
  const test::Scratch scratch;
  const std::string message = exr_message(foreign(scratch, {{"S0.550,0nm"}, {"S0.0,55um"}, {"S0.600,0nm"}}));
  EXPECT_NE(message.find("550 nm twice"), std::string::npos) << message;
}

TEST(SpectralExr, SaysWhatIsInAFileThatIsNotSpectral) {
  const test::Scratch scratch;
  const std::string message = exr_message(foreign(scratch, {{"R"}, {"G"}, {"B"}}));
  EXPECT_NE(message.find("B, G, R"), std::string::npos) << message;
  EXPECT_NE(exr_message(foreign(scratch, {{"S1.550,0nm"}})).find("polarised"), std::string::npos);
}

// ---- hostile

TEST(SpectralExr, MissingFilesFoldersAndOtherFormatsAreRefused) {
  const test::Scratch scratch;
  EXPECT_NE(exr_message(scratch.path("none.exr")).find("cannot be read"), std::string::npos);
  EXPECT_NE(exr_message(scratch.path("")).find("folder"), std::string::npos);
  EXPECT_NE(exr_message(scratch.with("text.exr", "not a picture at all")).find("not an OpenEXR"),
            std::string::npos);
  EXPECT_NE(exr_message(scratch.with("empty.exr", "")).find("not an OpenEXR"), std::string::npos);
}

TEST(SpectralExr, DamagedFilesDoNoHarm) {
  const test::Scratch scratch;
  write_spectral_exr(scratch.path("a.exr"), example_cube());
  const std::string bytes = read_whole_file(scratch.path("a.exr"));
  test::refuses_truncations(scratch, bytes, read_whole_exr);
  test::survives_flips(scratch, bytes, 500, read_whole_exr);
}

TEST(SpectralExr, RefusesASizeThatTheFileCannotHold) {
  const test::Scratch scratch;
  write_spectral_exr(scratch.path("a.exr"), example_cube());
  std::string bytes = read_whole_file(scratch.path("a.exr"));
  const std::size_t at =
      bytes.find("dataWindow") + std::strlen("dataWindow") + 1 + std::strlen("box2i") + 1 + 4;
  const std::int32_t window[] = {0, 0, 99999, 99999};
  std::memcpy(bytes.data() + at, window, sizeof window);
  const std::string message = exr_message(scratch.with("b.exr", bytes));
  EXPECT_NE(message.find("10000000000 pixels"), std::string::npos) << message;
}

/// OpenEXR reads a float of four bytes whatever size the file states, and would take the rest for attributes.
TEST(SpectralExr, RefusesAttributesWhoseSizeIsNotTheirTypes) {
  const test::Scratch scratch;
  write_spectral_exr(scratch.path("a.exr"), example_cube());
  std::string bytes = read_whole_file(scratch.path("a.exr"));
  const std::string attribute("pixelAspectRatio\0float\0", 23);
  const std::size_t size_at = bytes.find(attribute) + attribute.size();
  ASSERT_EQ(bytes[size_at], 4);
  bytes[size_at] = 12;
  bytes.insert(size_at + 8, std::string("x\0y\0\xFF\xFF\xFF\x70", 8));
  EXPECT_NE(exr_message(scratch.with("b.exr", bytes)).find("damaged"), std::string::npos);
}

TEST(SpectralExr, NanIsReadAndReportedByValidate) {
  const test::Scratch scratch;
  SpectralExr exr = example_cube();
  exr.plane(1)[2 * 7 + 3] = std::nanf("");
  write_spectral_exr(scratch.path("a.exr"), exr);
  const SpectralExr back = read_spectral_exr(scratch.path("a.exr"));
  try {
    back.validate("a.exr");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a.exr: the value at 587.56 nm, row 2, column 3"),
              std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(example_cube().validate("a.exr"));
}

TEST(SpectralExr, RefusesToWriteWhatIsNoImage) {
  const test::Scratch scratch;
  SpectralExr exr = example_cube();
  exr.values = LargeFloats(exr.values.size() - 1);
  EXPECT_THROW(write_spectral_exr(scratch.path("a.exr"), exr), InputError);
  exr = example_cube();
  exr.wavelengths_nm = {450, 450, 500};
  EXPECT_THROW(write_spectral_exr(scratch.path("a.exr"), exr), InputError);
  EXPECT_THROW(write_spectral_exr(scratch.path("a.exr"), SpectralExr{}), InputError);
  EXPECT_THROW(write_spectral_exr(scratch.path("no/folder.exr"), example_cube()), InputError);
  EXPECT_TRUE(scratch.is_empty());
}

TEST(SpectralExr, AFullDiskIsAFailureAndLeavesNothing) {
  const test::Scratch scratch;
  const SpectralExr exr = example_cube(64, 64);
  write_spectral_exr(scratch.path("whole.exr"), exr);
  const auto size = static_cast<rlim_t>(std::filesystem::file_size(scratch.path("whole.exr")));
  std::filesystem::remove(scratch.path("whole.exr"));
  std::signal(SIGXFSZ, SIG_IGN);  // writes beyond the limit then fail as on a full disk
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const rlim_t limit : {rlim_t{100}, size / 2, size - 1}) {  // the last one fails at the last byte only
    const rlimit small{limit, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(write_spectral_exr(scratch.path("a.exr"), exr), Failure) << limit;
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_TRUE(scratch.is_empty());
  }
}

}  // namespace
}  // namespace petzval
