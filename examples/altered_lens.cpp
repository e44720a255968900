// SPDX-License-Identifier: BSD-3-Clause
// A triplet in code, a gap opened in steps: MTF, PSF and picture of each. Ctrl-C ends it within a moment.
#include <petzval/petzval.h>

#include <csignal>
#include <cstdio>
using namespace petzval;
volatile std::sig_atomic_t stop = 0;

int main() try {
  std::signal(SIGINT, [](int) { stop = 1; });
  Context context;
  context.progress = [](double, const std::string&) { return stop == 0; };
  const Material air, crown = glass_material("HIKARI:SK16"), flint = glass_material("SCHOTT:F2");
  Camera camera;
  camera.sensor = read_sensor("example-vga", {"columns=160", "rows=120", "pitch_um=30"});
  camera.lens.aperture = {Aperture::Kind::f_number, 5};
  camera.lens.surfaces = {
      Surface::sphere(22.01359, 3.25896, crown, 9.5), Surface::sphere(-435.76044, 6.00755, air, 9.5),
      Surface::sphere(-22.21328, 0.99997, flint, 5),  Surface::sphere(20.29192, 4.75041, air, 5),
      Surface::sphere(79.68360, 2.95208, crown, 7.5), Surface::sphere(-18.39533, 42.20778, air, 7.5)};
  camera.lens.surfaces[3].stop = true;

  for (const char* gap_mm : {"6.008", "6.200", "6.400"}) {
    camera.lens.surfaces[1].thickness_mm = std::stod(gap_mm);
    const Lens lens = lens_in_use(camera, context);
    const double mtf = mtf_table(lens, {.fields = {0}}, {.frequencies_cpmm = {20}}).front().tangential;
    const PsfStack psf = psf_stack(lens, {.fields = {0, 7}}, {}, context);
    const SpectralImage light = image(SceneRequest{.name = "studio"}, camera, {}, context);
    const std::string file = "gap-" + std::string(gap_mm) + ".png";
    const Outputs made = write_outputs(light, {file}, camera.sensor, {}, context);
    std::printf("%s: MTF at 20/mm %.3f, PSF in %d x %d cells, %.2g s\n", file.c_str(), mtf, psf.size,
                psf.size, made.raw->exposure_s);
  }
} catch (const Cancelled&) {
  return 130;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
