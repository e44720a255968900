// SPDX-License-Identifier: BSD-3-Clause
// What altering a lens does to the picture: a triplet written down in code, one air gap opened in steps, and for each
// the light of a scene on the sensor, exposed, developed and saved. Ctrl-C ends it between any two steps.
#include <petzval/petzval.h>

#include <csignal>
#include <cstdio>

using namespace petzval;

volatile std::sig_atomic_t stop = 0;

int main() try {
  std::signal(SIGINT, [](int) { stop = 1; });
  Context context;
  context.note = [](const std::string& note) { std::fprintf(stderr, "note: %s\n", note.c_str()); };
  context.progress = [](double, const std::string&) { return stop == 0; };

  // Cooke triplet, 50 mm f/5: radius, thickness, glass, semi-diameter.
  const auto surface = [](double radius_mm, double thickness_mm, const char* glass, double semi_diameter_mm) {
    Surface s{.curvature_per_mm = radius_mm == 0 ? 0 : 1 / radius_mm, .thickness_mm = thickness_mm};
    if (*glass) s.material = glass_material(glass);
    s.semi_diameter_mm = semi_diameter_mm;
    return s;
  };
  Camera camera;
  camera.lens.name = "triplet";
  camera.lens.aperture = {Aperture::Kind::f_number, 5};
  camera.lens.surfaces = {surface(22.01359, 3.25896, "SCHOTT:SK16", 9.5),  surface(-435.76044, 6.00755, "", 9.5),
                          surface(-22.21328, 0.99997, "SCHOTT:F2", 5),     surface(20.29192, 4.75041, "", 5),
                          surface(79.68360, 2.95208, "SCHOTT:SK16", 7.5),  surface(-18.39533, 42.20778, "", 7.5)};
  camera.lens.surfaces[3].stop = true;
  camera.sensor = read_sensor("example-vga", {"pitch_um=30"});

  for (const double gap_mm : {6.00755, 6.2, 6.4}) {
    camera.lens.surfaces[1].thickness_mm = gap_mm;
    const SpectralImage light = image({.name = "studio"}, camera, {}, context);
    const Outputs made = write_outputs(light, {"gap-" + std::to_string(gap_mm) + ".png"}, camera.sensor, {}, context);
    std::printf("gap %.3f mm: focal length %.3f mm, exposed %.4f s\n", gap_mm, light.lens->focal_length_mm,
                made.raw->exposure_s);
  }
} catch (const Cancelled&) {
  return 130;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
