// SPDX-License-Identifier: BSD-3-Clause
#include "analytic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/optics/table_file.h>

#include <hdf5.h>
#include <sys/resource.h>

#include <unistd.h>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <thread>

#include "scratch.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;
using testing::analytic_table;

class TableFileTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch_.path(name); }

  const test::Scratch scratch_;
};

/// What read_table says against a file; empty if it takes it.
std::string complaint(const std::string& path, TableOrigin origin = TableOrigin::petzval) {
  try {
    read_table(path, origin);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string table_bytes(const std::string& path) {
  write_table(analytic_table(3), path);
  return read_whole_file(path);
}

void expect_same(const LensDataTable& a, const LensDataTable& b) {
  EXPECT_EQ(a.lens_name, b.lens_name);
  EXPECT_EQ(a.provenance, b.provenance);
  EXPECT_EQ(a.lens_json, b.lens_json);
  EXPECT_EQ(a.object_distance_mm, b.object_distance_mm);
  EXPECT_EQ(a.vertex_to_sensor_mm, b.vertex_to_sensor_mm);
  EXPECT_EQ(a.fields, b.fields);
  EXPECT_EQ(a.wavelengths_nm, b.wavelengths_nm);
  EXPECT_EQ(a.real_image_height_mm, b.real_image_height_mm);
  EXPECT_EQ(a.g_source_sr, b.g_source_sr);
  EXPECT_EQ(a.g_sensor_sr, b.g_sensor_sr);
  ASSERT_EQ(a.psf.size(), b.psf.size());
  for (std::size_t i = 0; i < a.psf.size(); ++i) {
    EXPECT_EQ(a.psf[i].size, b.psf[i].size);
    EXPECT_EQ(a.psf[i].spacing_um, b.psf[i].spacing_um);
    EXPECT_EQ(a.psf[i].captured, b.psf[i].captured);
    EXPECT_EQ(a.psf[i].values, b.psf[i].values);
  }
}

// Tables that were made for one image leave out PSFs between fields; a file would not say what stands for
// them.
TEST_F(TableFileTest, HoldsAllPsfs) {
  LensDataTable lean = analytic_table(5);
  lean.psf[lean.index(2, 0)] = {};
  EXPECT_NO_THROW(lean.validate());
  EXPECT_THROW(write_table(lean, path("lean.h5")), InputError);
  for (const std::size_t end : {std::size_t{0}, lean.fields.size() - 1}) {
    LensDataTable open = analytic_table(5);
    open.psf[open.index(end, 0)] = {};
    EXPECT_THROW(open.validate(), InputError);
  }
}

TEST_F(TableFileTest, ReturnsWhatWasWrittenToTheLastBit) {
  for (const bool finite : {false, true}) {
    LensDataTable table = analytic_table(7, {480, 550, 620});
    if (finite) table.object_distance_mm = 250.125;
    write_table(table, path("t.h5"));
    expect_same(table, read_table(path("t.h5")));
  }
}

// Every paraxial number has a value of its own, so that two that are swapped are noticed; infinities are
// allowed.
TEST_F(TableFileTest, KeepsTheFirstOrderData) {
  LensDataTable table = analytic_table(2);
  FirstOrder& written = table.first_order;
  written = {};
  double next = 1.25;
  for (double* number :
       {&written.wavelength_nm, &written.efl_mm, &written.bfl_mm, &written.ffl_mm, &written.f_number,
        &written.working_f_number, &written.image_space_na, &written.field_of_view_deg,
        &written.magnification, &written.entrance_pupil.position_mm, &written.entrance_pupil.diameter_mm,
        &written.exit_pupil.position_mm, &written.exit_pupil.diameter_mm, &written.petzval_radius_mm,
        &written.total_track_mm, &written.paraxial_image_mm, &written.stop_semi_diameter_mm,
        &written.lagrange_invariant_mm})
    *number = next++;
  written.petzval_radius_mm = -INFINITY;
  table.stop_semi_diameter_mm = 0.5;
  write_table(table, path("t.h5"));
  EXPECT_EQ(read_table(path("t.h5")).stop_semi_diameter_mm, 0.5);
  const FirstOrder read = read_table(path("t.h5")).first_order;
  // every member is a double: the whole struct can be compared
  static_assert(sizeof(FirstOrder) == 18 * sizeof(double));
  EXPECT_EQ(std::memcmp(&read, &written, sizeof read), 0);
}

TEST_F(TableFileTest, HasTheSameBytesEachTime) {
  write_table(analytic_table(), path("a.h5"));
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // a stored time would have moved by a second
  write_table(analytic_table(), path("b.h5"));
  EXPECT_EQ(read_whole_file(path("a.h5")), read_whole_file(path("b.h5")));
}

TEST_F(TableFileTest, RefusesToWriteWhatIsNoTable) {
  LensDataTable table = analytic_table();
  table.g_source_sr[3] = NAN;
  EXPECT_THROW(write_table(table, path("t.h5")), InputError);
  EXPECT_FALSE(fs::exists(path("t.h5")));
  EXPECT_THROW(write_table(analytic_table(), path("no/such/folder/t.h5")), InputError);
}

// A limit on file size stands in for a full disk.
TEST_F(TableFileTest, LeavesNothingBehindOnAFullDisk) {
  struct sigaction ignore {
  }, before{};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &ignore, &before);
  rlimit old{}, tight{};
  getrlimit(RLIMIT_FSIZE, &old);
  tight = {4096, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &tight);
  EXPECT_THROW(write_table(analytic_table(), path("t.h5")), Failure);
  setrlimit(RLIMIT_FSIZE, &old);
  sigaction(SIGXFSZ, &before, nullptr);
  EXPECT_TRUE(scratch_.is_empty());
}

TEST_F(TableFileTest, RefusesWhatIsNoFile) {
  EXPECT_NE(complaint(path("absent.h5")).find("cannot be read"), std::string::npos);
  EXPECT_NE(complaint(scratch_.folder().string()).find("is a folder"), std::string::npos);
  write_whole_file(path("empty.h5"), "");
  EXPECT_NE(complaint(path("empty.h5")).find("not an HDF5 file"), std::string::npos);
  write_whole_file(path("text.h5"), "radius 12\n");
  EXPECT_NE(complaint(path("text.h5")).find("not an HDF5 file"), std::string::npos);
}

TEST_F(TableFileTest, RefusesEveryTruncation) {
  const std::string whole = table_bytes(path("t.h5"));
  for (std::size_t length = 0; length < whole.size(); length += length < 1200 ? 37 : 211) {
    write_whole_file(path("cut.h5"), whole.substr(0, length));
    EXPECT_FALSE(complaint(path("cut.h5")).empty()) << length << " of " << whole.size() << " bytes";
  }
  write_whole_file(path("long.h5"), whole + "x");
  EXPECT_NE(complaint(path("long.h5")).find("damaged"), std::string::npos);
}

// Only the zeros behind the checksum may change.
TEST_F(TableFileTest, NoticesFlippedBits) {
  const std::string whole = table_bytes(path("t.h5"));
  const std::size_t padding = whole.find('\0');
  for (std::size_t at = 0; at < whole.size(); at += at < 600 ? 1 : 397) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (at % 8)));
    write_whole_file(path("flipped.h5"), flipped);
    const bool harmless = at >= padding && at < 512;
    EXPECT_EQ(complaint(path("flipped.h5")).empty(), harmless) << "byte " << at;
  }
}

TEST_F(TableFileTest, KeepsHdf5FromDamagedFilesWithoutAChecksum) {
  // Flipped bits in HDF5's own structures make it follow wild pointers: it must not see such a file.
  std::string bytes = table_bytes(path("t.h5"));
  bytes.replace(0, 512, std::string(512, '\0'));
  const std::string bare = bytes.substr(512);
  for (const std::string& whole : {bytes, bare})
    for (std::size_t at = 0; at < whole.size(); at += 97) {
      std::string flipped = whole;
      flipped[at] = static_cast<char>(flipped[at] ^ 0x55);
      write_whole_file(path("flipped.h5"), flipped);
      EXPECT_FALSE(complaint(path("flipped.h5")).empty()) << "byte " << at;
    }
  write_whole_file(path("bare.h5"), bare);
  EXPECT_NE(complaint(path("bare.h5")).find("importing it (from hdf5)"), std::string::npos);
}

/// The table without its seal, as another program would have stored it, with something altered by the HDF5
/// library.
class ForeignTableTest : public TableFileTest {
 protected:
  std::string altered(const std::function<void(hid_t file)>& alter) {
    std::string bytes = table_bytes(path("t.h5"));
    bytes.replace(0, 512, std::string(512, '\0'));
    write_whole_file(path("foreign.h5"), bytes);
    const hid_t file = H5Fopen(path("foreign.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    alter(file);
    H5Fclose(file);
    return complaint(path("foreign.h5"), TableOrigin::elsewhere);
  }

  static void replace_dataset(hid_t file, const char* name, const std::vector<hsize_t>& sizes,
                              bool chunked = false) {
    H5Ldelete(file, name, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    if (chunked)
      H5Pset_chunk(properties, static_cast<int>(sizes.size()), std::vector<hsize_t>(sizes.size(), 1).data());
    H5Dclose(H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
    H5Pclose(properties);
    H5Sclose(space);
  }

  static void write_doubles(hid_t file, const char* name, const std::vector<double>& values) {
    const hid_t data = H5Dopen2(file, name, H5P_DEFAULT);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(data);
  }
};

TEST_F(ForeignTableTest, IsReadOnRequest) {
  EXPECT_EQ(altered([](hid_t) {}), "");
  expect_same(read_table(path("foreign.h5"), TableOrigin::elsewhere), analytic_table(3));
}

TEST_F(ForeignTableTest, IsRefusedForWhatIsWrong) {
  const auto expect = [&](const char* words, const std::function<void(hid_t)>& alter) {
    const std::string said = altered(alter);
    EXPECT_NE(said.find(words), std::string::npos) << "expected: " << words << "\nsaid: " << said;
    EXPECT_NE(said.find("foreign.h5"), std::string::npos);
    EXPECT_EQ(said.find('\n'), std::string::npos);
  };
  expect("has no dataset psf", [](hid_t f) { H5Ldelete(f, "psf", H5P_DEFAULT); });
  expect("has no group first_order", [](hid_t f) { H5Ldelete(f, "first_order", H5P_DEFAULT); });
  expect("has no attribute format", [](hid_t f) { H5Adelete(f, "format"); });
  expect("g_source is [2 x 3]", [](hid_t f) { replace_dataset(f, "g_source", {2, 3}); });
  expect("one axis of 1 to", [](hid_t f) { replace_dataset(f, "object_field", {3, 2}); });
  expect("one axis of 1 to", [](hid_t f) { replace_dataset(f, "wavelength", {4'000'000'000u}, true); });
  expect("has no dataset g_source", [](hid_t f) {
    H5Ldelete(f, "g_source", H5P_DEFAULT);
    H5Gclose(H5Gcreate2(f, "g_source", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  });
  expect("is nan", [](hid_t f) { write_doubles(f, "g_source", {NAN, 1, 1, 1, 1, 1}); });
  expect("fields must increase", [](hid_t f) { write_doubles(f, "object_field", {0, 10, 5}); });
  expect("does not fit into squares", [](hid_t f) { write_doubles(f, "psf_size", {1, 2, 3, 4, 5, 1000}); });
  expect("does not fit into squares", [](hid_t f) { write_doubles(f, "psf_size", {-1, 2, 3, 4, 5, 6}); });
  expect("sums to", [](hid_t f) { write_doubles(f, "psf_size", {1, 1, 1, 1, 1, 1}); });
  expect("spacing", [](hid_t f) { write_doubles(f, "psf_spacing", {0, 1, 1, 1, 1, 1}); });
  expect("g_sensor claims", [](hid_t f) {
    replace_dataset(f, "g_sensor", {3, 2}, true);
  });  // no chunk ever written
}

TEST_F(ForeignTableTest, DoesNoHarmWhenDamaged) {
  EXPECT_EQ(altered([](hid_t) {}), "");
  const std::string whole = read_whole_file(path("foreign.h5"));
  for (std::size_t length = 0; length < whole.size(); length += whole.size() / 25) {
    write_whole_file(path("cut.h5"), whole.substr(0, length));
    EXPECT_NE(complaint(path("cut.h5"), TableOrigin::elsewhere), "") << length;
  }
  // Every sixteenth byte of all ones: whether it is a size, an address or a number, it is refused in one
  // line, or a table comes out.
  int refused = 0;
  for (std::size_t at = 512; at < whole.size(); at += std::max<std::size_t>(16, whole.size() / 150)) {
    std::string damaged = whole;
    damaged[at] = '\xff';
    write_whole_file(path("damaged.h5"), damaged);
    const std::string said = complaint(path("damaged.h5"), TableOrigin::elsewhere);
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    refused += !said.empty();
  }
  EXPECT_GT(refused, 5);
}

TEST_F(ForeignTableTest, IsRefusedBeforeMemoryIsTaken) {
  const std::string huge = altered([](hid_t f) {
    replace_dataset(f, "psf", {3, 2, 1'000'000, 1'000'000}, true);
  });
  EXPECT_NE(huge.find("GiB of memory"), std::string::npos) << huge;
  const std::string hollow = altered([](hid_t f) {
    replace_dataset(f, "psf", {3, 2, 10'000, 10'000}, true);
  });
  EXPECT_NE(hollow.find("are stored"), std::string::npos) << hollow;
}

/// h5py of the system's Python: a reader that we did not write.
TEST_F(TableFileTest, OpensInH5py) {
  const std::string python = "/usr/bin/python3 ";
  if (std::system((python + "-c 'import h5py' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "python3-h5py is absent";
  LensDataTable table = analytic_table(3);
  table.object_distance_mm = 250;
  write_table(table, path("t.h5"));
  write_whole_file(path("check.py"), R"(
import h5py, math, sys
with h5py.File(sys.argv[1]) as f:
    assert f.attrs['format'] == 'petzval-optics/1'
    assert f.attrs['lens_json'] == '{"name": "analytic, ƒ = 6 mm"}'
    assert f.attrs['object_distance_mm'] == 250
    assert f.attrs['vertex_to_sensor_mm'] == 6.25
    assert f['first_order'].attrs['efl_mm'] == 6 and f['first_order'].attrs['petzval_radius_mm'] == -math.inf
    assert list(f['object_field']) == [0, 15, 30] and f['object_field'].attrs['units'] == 'mm'
    assert list(f['wavelength']) == [500, 600] and f['wavelength'].attrs['units'] == 'nm'
    assert f['real_image_height'].shape == (3, 2) and f['real_image_height'].attrs['units'] == 'mm'
    t = math.tan(math.radians(15)); edge = math.tan(math.radians(30))
    assert abs(f['real_image_height'][1, 1] - 6 * 0.99 * t * (1 - 0.1 * t * t / edge ** 2)) < 1e-14
    assert abs(f['g_source'][0, 0] - math.pi / 16) < 1e-15 and f['g_source'].attrs['units'] == 'sr'
    psf = f['psf']
    assert psf.dtype == 'float32' and psf.shape == (3, 2, 10, 10) and psf.attrs['long_name']
    assert [d.label for d in psf.dims] == ['object_field', 'wavelength', 'tangential', 'sagittal']
    assert list(psf.dims[0][0]) == [0, 15, 30] and list(psf.dims[1][0]) == [500, 600]
    assert h5py.h5ds.is_scale(f['object_field'].id) and len(f['object_field'].attrs['REFERENCE_LIST']) == 7
    assert abs(psf[2, 1].sum() - 1) < 1e-6
    # the smallest PSF, 5 x 5, is the first: its centre is the centre of the square, nothing around it
    assert f['psf_size'][0, 0] == 5 and psf[0, 0, 5, 5] > 0 and (psf[0, 0] > 0).sum() == 25
    assert (psf[0, 0, 3:8, 3:8] > 0).all()
    # coma: more light at +t, away from the axis, than at -t; less so along s
    assert psf[0, 0, 6, 5] > psf[0, 0, 5, 6] > psf[0, 0, 5, 4] > psf[0, 0, 4, 5]
# as a user would keep an altered copy (opened anew: H5Ocopy of HDF5 1.10.8 overruns its buffer on chunks in the cache)
with h5py.File(sys.argv[1]) as f, h5py.File(sys.argv[2], 'w') as g:
    for name in f: f.copy(name, g)
    for name, value in f.attrs.items(): g.attrs[name] = value
    g.attrs['lens_name'] = 'altered'
)");
  ASSERT_EQ(std::system((python + path("check.py") + " " + path("t.h5") + " " + path("copy.h5")).c_str()), 0);
  table.lens_name = "altered";
  expect_same(read_table(path("copy.h5"), TableOrigin::elsewhere), table);
}

}  // namespace
}  // namespace petzval
