// SPDX-License-Identifier: BSD-3-Clause
// What altering a lens does to the picture: a triplet written down in code, one air gap opened in steps, and
// for each the light of a scene on the sensor, exposed, developed and saved. Ctrl-C ends it within a moment.
#include <petzval/petzval.h>

#include <csignal>
#include <cstdio>

using namespace petzval;

volatile std::sig_atomic_t stop = 0;

Surface surface(double radius_mm, double thickness_mm, const Material& behind, double semi_diameter_mm) {
  return {.curvature_per_mm = 1 / radius_mm,
          .thickness_mm = thickness_mm,
          .material = behind,
          .semi_diameter_mm = semi_diameter_mm};
}

int main() try {
  std::signal(SIGINT, [](int) { stop = 1; });
  Context context;
  context.note = [](const std::string& note) { std::fprintf(stderr, "note: %s\n", note.c_str()); };
  context.progress = [](double, const std::string&) { return stop == 0; };

  const Material air, crown = glass_material("HIKARI:SK16"), flint = glass_material("SCHOTT:F2");
  Camera camera;
  camera.lens.name = "triplet";
  camera.lens.aperture = {Aperture::Kind::f_number, 5};
  camera.lens.surfaces = {surface(22.01359, 3.25896, crown, 9.5), surface(-435.76044, 6.00755, air, 9.5),
                          surface(-22.21328, 0.99997, flint, 5),  surface(20.29192, 4.75041, air, 5),
                          surface(79.68360, 2.95208, crown, 7.5), surface(-18.39533, 42.20778, air, 7.5)};
  camera.lens.surfaces[3].stop = true;
  camera.sensor = read_sensor("example-vga", {"columns=160", "rows=120", "pitch_um=30"});

  for (const double gap_mm : {6.008, 6.2, 6.4}) {
    camera.lens.surfaces[1].thickness_mm = gap_mm;
    const SpectralImage light = image(SceneRequest{.name = "studio"}, camera, {}, context);
    char file[32];
    std::snprintf(file, sizeof file, "gap-%.3f.png", gap_mm);
    const Outputs made = write_outputs(light, {file}, camera.sensor, {}, context);
    std::printf("%s: focal length %.3f mm, exposed for %.2g s\n", file, light.lens->focal_length_mm,
                made.raw->exposure_s);
  }
} catch (const Cancelled&) {
  return 130;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
