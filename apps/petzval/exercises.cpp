// SPDX-License-Identifier: BSD-3-Clause
#include "exercises.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>

namespace petzval::app {

namespace {

constexpr auto a_drawing = ExerciseStep::Makes::drawing, a_plot = ExerciseStep::Makes::plot,
               a_picture = ExerciseStep::Makes::picture, a_lens = ExerciseStep::Makes::lens;

std::vector<Exercise> all_exercises() {
  return {
      {"defocus",
       "Defocus",
       "The sensor of an f/4 lens stands 0.2 mm, then 0.5 mm behind its focus. How wide is the image of a "
       "point, in pixels "
       "of 20 µm? What does stopping down to f/8 change, and why?",
       {{a_drawing, "lens draw achromat-50mm --fields 0 --rays 9",
         "All light of a point crosses in the focus."},
        {a_plot,
         "lens mtf achromat-50mm --fields 0 --wavelengths 588 --frequencies 5,10,20 --through-focus 0.5",
         "Contrast against the place of the sensor: fine detail goes first."},
        {a_picture,
         "image studio --surround extend --lens achromat-50mm --sensor 240x180@20 --wavelengths 450:50:650",
         "In focus, f/4."},
        {a_picture,
         "image studio --surround extend --lens achromat-50mm --sensor 240x180@20 --wavelengths 450:50:650 "
         "--defocus 0.2",
         "0.2 mm behind the focus: a disc of 0.2 mm / 4 = 50 µm."},
        {a_picture,
         "image studio --surround extend --lens achromat-50mm --sensor 240x180@20 --wavelengths 450:50:650 "
         "--defocus 0.5",
         "0.5 mm: 125 µm, six pixels."},
        {a_picture,
         "image studio --surround extend --lens achromat-50mm --sensor 240x180@20 --wavelengths 450:50:650 "
         "--defocus 0.5 "
         "--f-number 8",
         "0.5 mm at f/8: half the disc."}}},
      {"spherical-aberration",
       "Spherical aberration",
       "The same plano-convex lens looks at a distant chart both ways round. Which side should face the "
       "chart, and by "
       "what factor does the blur differ? (Third order: 3.9.)",
       {{a_drawing, "lens draw plano-convex --fields 0 --rays 11",
         "Rays of the rim cross the axis before the others."},
        {a_plot, "lens fans plano-convex --fields 0 --wavelengths 588",
         "Where a ray meets the sensor grows as the cube of its height at the stop."},
        {a_picture,
         "image studio --surround extend --lens plano-convex --sensor 240x180@20 --wavelengths 588 --focus "
         "paraxial",
         "Curved side to the chart, in the paraxial focus."},
        {a_picture,
         "image studio --surround extend --lens plano-convex-reversed --sensor 240x180@20 --wavelengths 588 "
         "--focus paraxial",
         "Flat side to the chart."},
        {a_picture,
         "image studio --surround extend --lens plano-convex --sensor 240x180@20 --wavelengths 588 --focus "
         "paraxial --defocus "
         "-0.6",
         "Curved side to the chart, 0.6 mm nearer to the lens: the least blur is not in the paraxial focus."},
        {a_picture,
         "image studio --surround extend --lens plano-convex --sensor 240x180@20 --wavelengths 588 --focus "
         "paraxial --f-number "
         "8",
         "In the paraxial focus at f/8: an eighth of the blur."}}},
      {"coma",
       "Coma",
       "This lens is perfect on its axis. What do stars beside the axis look like, which way do they point, "
       "and how do they "
       "shrink when the lens is stopped down?",
       {{a_drawing, "lens draw coma-singlet --rays 9",
         "A hyperboloid: rays along the axis meet in one point, oblique ones do not."},
        {a_plot, "lens spots coma-singlet --fields 0,1,2,3 --wavelengths 588",
         "Each ring of the stop makes a circle of its own, shifted by its own width: the comet."},
        {a_picture, "image points:7 --lens coma-singlet --sensor 240x180@25 --wavelengths 588",
         "A grid of stars, f/4."},
        {a_picture,
         "image points:7 --lens coma-singlet --sensor 240x180@25 --wavelengths 588 "
         "--f-number 8",
         "f/8: coma goes with the square of the stop, to a quarter."},
        {a_picture,
         "image studio --surround extend --lens coma-singlet --sensor 240x180@25 --wavelengths 450:50:650",
         "The middle is sharp but for colour; towards the corners detail grows tails."}}},
      {"field-curvature",
       "Astigmatism and field curvature",
       "No place of the sensor makes all of the grid sharp. Where does each part have its focus, and why are "
       "lines towards "
       "the centre and lines about it sharp at different places?",
       {{a_drawing, "lens draw plano-convex --fields 0,8,16", "Oblique bundles meet before the flat sensor."},
        {a_plot, "lens field-curvature plano-convex --fields 0:4:16 --wavelengths 588",
         "Tangential (solid) and sagittal (dashed) foci, and Petzval's curve."},
        {a_picture,
         "image grid:12 --surround extend --lens plano-convex --sensor 240x180@100 --wavelengths 588 "
         "--f-number 8 --focus "
         "infinity",
         "Focused for the middle."},
        {a_picture,
         "image grid:12 --surround extend --lens plano-convex --sensor 240x180@100 --wavelengths 588 "
         "--f-number 8 --focus "
         "infinity --defocus -2.5",
         "2.5 mm nearer: the middle blurs, the zone beside it is sharp."},
        {a_picture,
         "image grid:12 --surround extend --lens landscape-lens --sensor 240x180@100 --wavelengths 588 "
         "--focus infinity",
         "A meniscus behind a stop, f/11: its tangential field is flat."}}},
      {"distortion",
       "Distortion",
       "All lines of the chart are straight. What has the place of the stop to do with how they bend?",
       {{a_drawing, "lens draw landscape-lens", "The stop stands in front of the lens."},
        {a_plot, "lens distortion landscape-lens --fields 0:5:25 --wavelengths 588",
         "Distortion about the centre, against the height in the image."},
        {a_lens, "lens reverse landscape-lens", ""},
        {a_picture,
         "image grid:12 --surround extend --lens landscape-lens --sensor 240x180@150 --wavelengths 588",
         "Stop in front: barrel."},
        {a_picture,
         "image grid:12 --surround extend --lens distortion-3.json --sensor 240x180@150 --wavelengths 588",
         "The same lens turned round, stop behind: pincushion."}}},
      {"colour",
       "Axial and lateral colour",
       "A singlet has another focal length for each wavelength. What of that is seen in the middle of the "
       "picture, what at "
       "its border, and what does a second glass mend?",
       {{a_drawing, "lens draw plano-convex --fields 0 --rays 7", "One glass: one focus for each colour."},
        {a_plot, "lens colour plano-convex --wavelengths 450,550,650",
         "Left: where zones of the stop focus. Right: how high chief rays come, against the reference."},
        {a_picture,
         "image studio --surround extend --lens plano-convex --sensor 240x180@20 --wavelengths 450:25:650 "
         "--focus infinity",
         "The singlet, f/4: coloured haze."},
        {a_picture,
         "image studio --surround extend --lens achromat-50mm --sensor 240x180@20 --wavelengths 450:25:650 "
         "--focus infinity",
         "The achromat, f/4: blue and red have one focus."},
        {a_picture,
         "image grid:24 --surround extend --lens landscape-lens --sensor 240x180@100 --wavelengths "
         "450:25:650 --focus infinity",
         "A stop away from the lens: fringes that grow towards the border, lateral colour."}}},
      {"vignetting",
       "Vignetting",
       "An evenly lit wall. Why are the corners dark at f/2 and less so at f/8, and what remains?",
       {{a_drawing, "lens draw dgauss-50mm --rays 9", "Rims of the outer lenses cut the oblique bundles."},
        {a_plot, "lens vignetting dgauss-50mm --wavelengths 588",
         "Share of the stop that light fills, by field."},
        {a_picture, "image wall --lens dgauss-50mm --sensor 160x120@225 --wavelengths 588", "f/2."},
        {a_picture, "image wall --lens dgauss-50mm --sensor 160x120@225 --wavelengths 588 --f-number 8",
         "f/8, shown as bright: the fall that is left is that of cos⁴."},
        {a_picture, "image points:5 --lens dgauss-50mm --sensor 160x120@225 --wavelengths 588 --defocus 1.5",
         "Lights out of focus are pictures of the pupil: round in the middle, cat's eyes at the border."}}},
      {"depth-of-field",
       "Depth of field",
       "Three cards at 0.6, 1 and 1.8 m, the middle one in focus. Which stop makes all of them sharp to a "
       "pixel, and what "
       "is paid for it?",
       {{a_drawing, "lens draw dgauss-50mm --fields 0 --focus 1m --rays 9", "Focused at 1 m."},
        {a_plot,
         "lens mtf dgauss-50mm --fields 0 --wavelengths 588 --frequencies 2,5,10 --through-focus 1 --focus "
         "1m",
         "Contrast against the place of the sensor at f/2: the near card has its image behind it, the far "
         "one before it."},
        {a_picture,
         "image cards --lens dgauss-50mm --sensor 160x120@150 --wavelengths 450,550,650 --focus 1m "
         "--tolerance 0.01",
         "f/2."},
        {a_picture,
         "image cards --lens dgauss-50mm --sensor 160x120@150 --wavelengths 450,550,650 --focus 1m "
         "--tolerance 0.01 --f-number 5.6",
         "f/5.6."},
        {a_picture,
         "image cards --lens dgauss-50mm --sensor 160x120@150 --wavelengths 450,550,650 --focus 1m "
         "--tolerance 0.01 --f-number 16",
         "f/16: an eighth of the disc, a 64th of the light."}}},
      {"autofocus",
       "Autofocus",
       "A camera that sees only its own pictures has to find the place of the sensor. What does it measure, "
       "and why does "
       "the answer depend on where one points it?",
       {{a_drawing, "lens draw dgauss-50mm --fields 0 --rays 9", "The camera moves the sensor, or the lens."},
        {a_plot, "focus spheres --lens dgauss-50mm --scene-unit 600 --size 160x120 --zone 0.05,0.4,0.8,1",
         "The measure of sharpness (the energy of gradients) at the places that were tried."},
        {a_picture,
         "render spheres --lens dgauss-50mm --scene-unit 600 --size 160x120 --spp 32 --white 70 --zone "
         "0.05,0.4,0.8,1",
         "Zone at the lower left, the floor in front."},
        {a_picture,
         "render spheres --lens dgauss-50mm --scene-unit 600 --size 160x120 --spp 32 --white 70 --zone "
         "0.25,0.55,0.28,0.38",
         "Zone on the floor behind."}}}};
}

const char* ending_of(ExerciseStep::Makes makes) {
  return makes == a_picture ? "png" : makes == a_lens ? "json" : "svg";
}

}  // namespace

const std::vector<Exercise>& exercises() {
  static const std::vector<Exercise> all = all_exercises();
  return all;
}

const Exercise& exercise(const std::string& name) {
  std::vector<std::string> names;
  for (const Exercise& each : exercises()) {
    if (each.name == name) return each;
    names.push_back(each.name);
  }
  throw InputError(
      fmt::format("no exercise is called {}; {} would be right", quotable(name), fmt::join(names, ", ")));
}

std::string output_of(const Exercise& exercise, std::size_t step) {
  return fmt::format("{}-{}.{}", exercise.name, step + 1, ending_of(exercise.steps[step].makes));
}

std::string command_line(const Exercise& exercise, std::size_t step) {
  const ExerciseStep& each = exercise.steps[step];
  return fmt::format("petzval {} {} {}", each.words, each.makes == a_plot ? "--plot" : "-o",
                     output_of(exercise, step));
}

}  // namespace petzval::app
