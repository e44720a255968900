// SPDX-License-Identifier: BSD-3-Clause
// Files that are broken, absurd or meant to harm: each is read, or refused in one line that names it.
#include "bench_samples.h"
#include "random_lens.h"
#include "sample_lenses.h"
#include "scratch_file.h"

#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/flaresim.h>
#include <petzval/lens/formats/iset.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/optical_bench.h>
#include <petzval/lens/formats/pbrt.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/zmx.h>

#include <filesystem>

namespace petzval {
namespace {

using namespace testing;

std::string file_text(const std::string& name, const std::string& extension) {
  if (extension == ".txt") return bench("AsphericalOddCount\t1\n", singlet, "1\t51.68\t-0.5\t1e-5\t1e-7\n");
  if (extension == ".lens") return flare_rows;
  ScratchFile file("whole" + extension);
  write_lens(with_setting(read_lens(name).lens, "source=a test"), file.path());
  return read_whole_file(file.path());
}

/// As read_lens() does once it has the bytes of the file: thousands of real files would take a minute.
Lens lens_from_bytes(const std::string& file, const std::string& bytes) {
  const std::string extension = std::filesystem::path(file).extension();
  if (extension == ".zmx") return read_zmx(decoded_text(bytes), file, {}).lens;
  if (extension == ".seq") return read_seq(decoded_text(bytes), file, {}).lens;
  if (extension == ".dat") return read_pbrt(decoded_text(bytes), file).lens;
  if (extension == ".txt") return read_optical_bench(decoded_text(bytes), file, {}).lens;
  if (extension == ".lens") return read_flaresim(decoded_text(bytes), file).lens;
  const JsonDocument document(bytes, file);
  return is_iset(document) ? read_iset(document).lens : read_native(document, {});
}

/// Reads whatever it is; a lens that comes out must be one that can be used.
bool survives(const std::string& file, const std::string& bytes) {
  try {
    lens_from_bytes(file, bytes).validate();
    return true;
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.compare(0, file.size() + 1, file + ":"), 0) << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
    EXPECT_LT(message.size(), 600u) << message;
    return false;
  }
}

class HostileFile : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  std::string text_ = file_text(GetParam().second, GetParam().first);
  std::string file_ = std::string("hostile") + GetParam().first;
};

TEST_P(HostileFile, Truncated) {
  for (std::size_t length = 0; length < text_.size(); length += 7) survives(file_, text_.substr(0, length));
}

TEST_P(HostileFile, BytesExchanged) {
  RandomLens random(6);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = text_;
    for (std::size_t n = 1 + random.below(4); n > 0; --n)
      bytes[random.below(bytes.size())] =
          static_cast<char>(random.chance(0.5) ? random.below(256) : "0\"{}[]-.eE, \n"[random.below(13)]);
    survives(file_, bytes);
  }
}

TEST_P(HostileFile, WordsExchanged) {
  const char* const words[] = {"1e999", "-1e308", "nan",      "inf",      "-0",   "99999999999999999999",
                               "\"\"",  "null",   "[]",       "{}",       "true", "1e-320",
                               "SURF",  "STOP",   "INFINITY", "\xFF\xFE", "x"};
  RandomLens random(7);
  const std::string_view text = text_;
  for (int i = 0; i < 2000; ++i) {
    const std::size_t start =
        std::min(text.find_first_of(" \t:[", random.below(text.size())), text.size() - 1) + 1;
    const std::size_t end = std::min(text.find_first_of(" \t,\n]}", start), text.size());
    std::string bytes(text.substr(0, start));
    bytes += words[random.below(std::size(words))];
    bytes += text.substr(end);
    survives(file_, bytes);
  }
}

TEST_P(HostileFile, Absurd) {
  for (const std::string& bytes :
       {std::string("\0", 1), std::string(1000, '\0'), std::string("\xFF\xFE"),
        std::string("\xFF\xFE\x00", 3), std::string("\x89PNG\r\n\x1A\n"), std::string(200'000, '['),
        std::string(200'000, '{'), "{\"a\":" + std::string(100'000, '['), std::string(500'000, '0'),
        std::string(500'000, '\n'), "[" + std::string(400'000, ',') + "]",
        "{\"" + std::string(500'000, 'k') + "\": 1}",
        std::string("{\"surfaces\": [{\"ior\": 1e308, \"radius\": 1e-308, \"semi_aperture\": 1, "
                    "\"thickness\": 1}]}")})
    EXPECT_FALSE(survives(file_, bytes)) << bytes.substr(0, 40);
  std::string many = "[0";
  for (int i = 0; i < 300'000; ++i) many += ",0";
  EXPECT_FALSE(survives(file_, many + "]"));
}

TEST_P(HostileFile, TooLarge) {
  expect_mentions(error_of([&] { read_text(file_, std::string(9u << 20, ' ')); }), {"larger"});
}

INSTANTIATE_TEST_SUITE_P(Formats, HostileFile,
                         ::testing::Values(std::pair(".json", "edmund-54852"),
                                           std::pair(".zmx", "us-2532751"),
                                           std::pair(".seq", "cooke-triplet"),
                                           std::pair(".dat", "dgauss-50mm"), std::pair(".txt", ""),
                                           std::pair(".lens", ""), std::pair(".iset.json", "dgauss-50mm")),
                         [](const auto& format) {
                           std::string name = format.param.first + 1;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST(HostileLens, ExtremeNumbersEndInNumbersOrErrors) {
  RandomLens random(8);
  for (int i = 0; i < 500; ++i) {
    Lens lens = random();
    for (Surface& surface : lens.surfaces) surface.thickness_mm *= std::exp2(800 * random.uniform() - 400);
    try {
      // Overflow may leave infinities, never a crash.
      first_order(lens);
    } catch (const InputError&) {
    }
  }
}

TEST(HostileLens, EmptyAndMissingFiles) {
  for (const char* name : {"empty.json", "empty.zmx", "empty.dat"}) {
    ScratchFile file(name);
    write_whole_file(file.path(), "");
    expect_mentions(error_of([&] { read_lens(file.path()); }), {name, "empty"});
  }
  ScratchFile folder("folder.json");
  std::filesystem::create_directories(folder.path());
  expect_mentions(error_of([&] { read_lens(folder.path()); }), {"folder.json"});
  expect_mentions(error_of([] { read_lens("no/such/lens.json"); }), {"no/such/lens.json"});
}

TEST(HostileLens, NothingIsWrittenWhenItCannotBeHeld) {
  ScratchFile file("out.dat");
  error_of([&] { write_lens(read_lens("cooke-triplet").lens, file.path()); });
  EXPECT_FALSE(std::filesystem::exists(file.path()));
}

}  // namespace
}  // namespace petzval
