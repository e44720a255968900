// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/pupil_fit.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/optics/frame_build.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace petzval {

namespace {

using Vector2 = std::array<double, 2>;
/// Columns: what a step along x and along y does.
using Matrix2 = std::array<Vector2, 2>;

Vector2 times(const Matrix2& matrix, const Vector2& v) {
  return {matrix[0][0] * v[0] + matrix[1][0] * v[1], matrix[0][1] * v[0] + matrix[1][1] * v[1]};
}

/// What an object is seen to do, and what step of the object moves its image so.
struct SeenObject {
  Vector2 object{};
  Matrix2 object_per_mm{};
};

/// A field tracer's azimuth of a vector, and the angle of a vector turned by half a turn.
double azimuth_of(const Vector2& v) {
  return degrees(std::atan2(-v[0], v[1]));
}

/// Which objects send their chief rays to given places, at one wavelength.
class ChiefAim {
 public:
  ChiefAim(const Lens& lens, double wavelength_nm, Tracer::Clip clip)
      : tracer_(lens, wavelength_nm, clip), sign_(towards_positive_image(lens)) {
    // About the axis the lens is a scale and, with poses, a shift and a turn: by differences.
    const double step = lens.object_distance_mm ? *lens.object_distance_mm / 1000 : 0.05;
    const auto middle = landing({0, 0}), right = landing({step, 0}), above = landing({0, step});
    if (!middle || !right || !above)
      throw InputError(
          fmt::format("{}: no chief ray passes beside the axis at {:g} nm", lens.name, wavelength_nm));
    const Vector2 x{((*right)[0] - (*middle)[0]) / step, ((*right)[1] - (*middle)[1]) / step},
        y{((*above)[0] - (*middle)[0]) / step, ((*above)[1] - (*middle)[1]) / step};
    const double determinant = x[0] * y[1] - x[1] * y[0];
    start_.object_per_mm = {Vector2{y[1] / determinant, -x[1] / determinant},
                            Vector2{-y[0] / determinant, x[0] / determinant}};
    middle_mm_ = *middle;
  }

  /// What lands on the axis, to start from.
  SeenObject start() const { return start_; }
  Vector2 middle_mm() const { return middle_mm_; }

  /// From an object whose image lies at `from_mm` to that whose image lies at `to_mm`, by Broyden's method.
  std::optional<SeenObject> aim(const SeenObject& start, const Vector2& from_mm, const Vector2& to_mm) {
    constexpr int most_steps = 40;
    constexpr double close_mm = 1e-9;
    SeenObject seen = start;
    Vector2 missing{to_mm[0] - from_mm[0], to_mm[1] - from_mm[1]};
    for (int i = 0; i < most_steps; ++i) {
      if (std::hypot(missing[0], missing[1]) < close_mm) return seen;
      Vector2 step = times(seen.object_per_mm, missing);
      std::optional<Vector2> there;
      // Where no chief ray passes so far out, not that far.
      for (int halving = 0; halving < 4 && !there; ++halving) {
        if (halving > 0) step = {step[0] / 2, step[1] / 2};
        there = landing({seen.object[0] + step[0], seen.object[1] + step[1]});
      }
      if (!there) return {};
      const Vector2 left{to_mm[0] - (*there)[0], to_mm[1] - (*there)[1]};
      const Vector2 moved{missing[0] - left[0], missing[1] - left[1]};
      seen.object = {seen.object[0] + step[0], seen.object[1] + step[1]};
      // The matrix that takes the move to the step and differs least from the last (Broyden 1965).
      const double square = moved[0] * moved[0] + moved[1] * moved[1];
      if (square > 0) {
        const Vector2 taken = times(seen.object_per_mm, moved);
        for (std::size_t k = 0; k < 2; ++k)
          for (std::size_t row = 0; row < 2; ++row)
            seen.object_per_mm[k][row] += (step[row] - taken[row]) * moved[k] / square;
      }
      missing = left;
    }
    return {};
  }

 private:
  std::optional<Vector2> landing(const Vector2& seen) {
    if (!tracer_.lens().object_distance_mm && std::hypot(seen[0], seen[1]) >= 179) return {};
    return tracer_.landing_mm(sign_ * seen[0], sign_ * seen[1]);
  }

  FieldTracer tracer_;
  double sign_;
  SeenObject start_;
  Vector2 middle_mm_{};
};

/// A chief ray in axes turned with its field.
struct TurnedChief {
  FieldTracer tracer;
  std::optional<ChiefRay> chief;

  TurnedChief(const Lens& lens, double wavelength_nm, const TableOptions& options, const Vector2& object)
      : tracer(lens, wavelength_nm, options.clip, azimuth_of(object)),
        chief(tracer.chief_ray(std::hypot(object[0], object[1]))) {}
};

/// FieldTracer::object_area_per_image_area(); nothing at the very last field, which has no neighbours.
std::optional<double> object_area(TurnedChief& at) {
  try {
    return at.tracer.object_area_per_image_area(*at.chief);
  } catch (const InputError&) {
    return {};
  }
}

/// Half a PSF's window beyond a frame [mm]; nothing where no ray passes.
double frame_reach_mm(const Lens& lens, const TableOptions& options, double wavelength_nm,
                      const Vector2& corner_mm) {
  ChiefAim aim(lens, wavelength_nm, options.clip);
  const double sign = towards_positive_image(lens);
  double reach_mm = 0;
  for (const Vector2& place : {Vector2{0, 0}, corner_mm, Vector2{-corner_mm[0], corner_mm[1]},
                               Vector2{corner_mm[0], -corner_mm[1]}, Vector2{-corner_mm[0], -corner_mm[1]}}) {
    const auto seen = aim.aim(aim.start(), aim.middle_mm(), place);
    if (!seen) continue;
    TurnedChief at(lens, wavelength_nm, options, {sign * seen->object[0], sign * seen->object[1]});
    const auto plan = at.chief ? plan_psf(at.tracer, *at.chief, psf_options_of(options)) : std::nullopt;
    if (plan)
      reach_mm = std::max(reach_mm, std::numbers::sqrt2 * 0.5 * plan->size * plan->spacing_um * mm_per_um);
  }
  return reach_mm;
}

std::vector<double> even_places(double half_mm, int count) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back(half_mm * (2.0 * i / (count - 1) - 1));
  return places;
}

FramePlaces lay_frame(const Lens& lens, const TableOptions& options) {
  const Vector2 frame =
      options.half_frame_mm.value_or(Vector2{options.max_image_height_mm, options.max_image_height_mm});
  const double reach_mm = std::max(frame_reach_mm(lens, options, options.wavelengths_nm.front(), frame),
                                   frame_reach_mm(lens, options, options.wavelengths_nm.back(), frame));
  const Vector2 half{frame[0] + reach_mm, frame[1] + reach_mm};
  // An odd number, so that the axis has a place.
  constexpr int fewest = 5;
  const auto places = [&](double of) {
    const int count = static_cast<int>(std::lround(options.frame_places * of / std::max(half[0], half[1])));
    return std::max(fewest, count | 1);
  };
  FramePlaces places_of_frame;
  places_of_frame.x_mm = even_places(half[0], places(half[0]));
  places_of_frame.y_mm = even_places(half[1], places(half[1]));
  return places_of_frame;
}

/// Places of a lattice from its middle outwards, each after the one next to it towards the middle.
class OutwardOrder {
 public:
  explicit OutwardOrder(const FramePlaces& frame)
      : across_(static_cast<int>(frame.x_mm.size())), down_(static_cast<int>(frame.y_mm.size())) {
    for (int place = 0; place < across_ * down_; ++place) order_.push_back(static_cast<std::size_t>(place));
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return rings(a) < rings(b); });
  }
  const std::vector<std::size_t>& order() const { return order_; }
  /// The middle has itself.
  std::size_t inner(std::size_t place) const {
    const auto [i, j] = offset(place);
    const auto step = [](int of) { return of == 0 ? 0 : of / std::abs(of); };
    const int column = static_cast<int>(place) % across_ - step(i),
              row = static_cast<int>(place) / across_ - step(j);
    return static_cast<std::size_t>(row * across_ + column);
  }

 private:
  std::array<int, 2> offset(std::size_t place) const {
    return {static_cast<int>(place) % across_ - across_ / 2, static_cast<int>(place) / across_ - down_ / 2};
  }
  int rings(std::size_t place) const {
    const auto [i, j] = offset(place);
    return std::max(std::abs(i), std::abs(j));
  }
  int across_, down_;
  std::vector<std::size_t> order_;
};

/// What every place sees at a wavelength; nothing where no chief ray lands.
std::vector<std::optional<SeenObject>> seen_objects(const Lens& lens, const TableOptions& options,
                                                    double wavelength_nm, const FramePlaces& frame) {
  ChiefAim aim(lens, wavelength_nm, options.clip);
  const OutwardOrder outward(frame);
  std::vector<std::optional<SeenObject>> seen(frame.count());
  for (const std::size_t place : outward.order()) {
    const auto at = [&](std::size_t p) {
      return Vector2{frame.x_mm[p % frame.x_mm.size()], frame.y_mm[p / frame.x_mm.size()]};
    };
    const std::size_t inner = outward.inner(place);
    if (inner != place && seen[inner])
      seen[place] = aim.aim(*seen[inner], at(inner), at(place));
    else
      seen[place] = aim.aim(aim.start(), aim.middle_mm(), at(place));
  }
  return seen;
}

/// One place at one wavelength; whether light arrives.
bool fill_place(const Lens& lens, const TableOptions& options, double wavelength_nm, double dark_area,
                const Vector2& seen, LensDataTable& table, std::size_t entry) {
  const double sign = towards_positive_image(lens);
  TurnedChief at(lens, wavelength_nm, options, {sign * seen[0], sign * seen[1]});
  if (!at.chief) return false;
  const auto lit = at.tracer.object_pupil(*at.chief);
  if (!lit || !(lit->area() > dark_area)) return false;
  at.tracer.set_losses(options.losses);
  const std::optional<SmoothPupil> pupil =
      at.tracer.tracer().is_centred() ? fit_pupil(at.tracer, *at.chief) : std::nullopt;
  std::optional<Psf> psf;
  if (pupil) psf = point_spread(*pupil, psf_options_of(options));
  if (!psf) psf = point_spread(at.tracer, *at.chief, psf_options_of(options));
  if (!psf) return false;
  const std::optional<double> area = object_area(at);
  if (!area) return false;
  table.g_source_sr[entry] = *area * (pupil ? pupil->flux : at.tracer.object_flux(*at.chief));
  table.g_sensor_sr[entry] = at.tracer.g_sensor_sr(*at.chief);
  table.psf[entry] = *psf;
  // A PSF's t points away from the axis, in axes turned with the field: the other way where the image lies
  // there.
  const double half_turn = at.chief->image_height_mm < 0 ? 180 : 0;
  double azimuth = azimuth_of({sign * seen[0], sign * seen[1]}) + half_turn;
  if (azimuth > 180) azimuth -= 360;
  table.frame->psf_azimuth_deg[entry] = azimuth;
  return true;
}

/// Places without light look on as those farther in do.
void extend_into_darkness(std::size_t wavelength, const std::vector<char>& lit, LensDataTable& table) {
  FramePlaces& frame = *table.frame;
  const OutwardOrder outward(frame);
  std::vector<std::size_t> light_of(frame.count());  // whose PSF stands for it
  for (const std::size_t place : outward.order()) {
    light_of[place] = place;
    if (lit[place] != 0) continue;
    const std::size_t inner = outward.inner(place), second = outward.inner(inner);
    const std::size_t here = table.index(place, wavelength), next = table.index(inner, wavelength),
                      further = table.index(second, wavelength);
    light_of[place] = light_of[inner];
    if (inner == place)
      throw InputError(
          fmt::format("{}: no ray passes the stop in the middle of the frame at {:g} nm; check stop "
                      "and clear apertures",
                      table.lens_name, table.wavelengths_nm[wavelength]));
    frame.object_x[here] = 2 * frame.object_x[next] - frame.object_x[further];
    frame.object_y[here] = 2 * frame.object_y[next] - frame.object_y[further];
    const std::size_t light = table.index(light_of[place], wavelength);
    frame.psf_azimuth_deg[here] = frame.psf_azimuth_deg[light];
    table.psf[here] = table.psf[light];
    table.g_source_sr[here] = table.g_sensor_sr[here] = 0;
  }
}

}  // namespace

void fill_frame(const Lens& lens, const TableOptions& options, LensDataTable& table,
                const ProgressCallback& progress) {
  table.frame = lay_frame(lens, options);
  FramePlaces& frame = *table.frame;
  const std::size_t places = frame.count(), wavelengths = table.wavelengths_nm.size(),
                    entries = places * wavelengths;
  for (std::vector<double>* values :
       {&frame.object_x, &frame.object_y, &frame.psf_azimuth_deg, &table.g_source_sr, &table.g_sensor_sr})
    values->resize(entries);
  table.psf.resize(entries);

  std::vector<std::vector<std::optional<SeenObject>>> seen(wavelengths);
  std::vector<double> dark_area(wavelengths, 0.0);
  parallel_for(wavelengths, [&](std::size_t w) {
    seen[w] = seen_objects(lens, options, table.wavelengths_nm[w], frame);
    FieldTracer tracer(lens, table.wavelengths_nm[w], options.clip);
    if (const auto axis = tracer.chief_ray(0))
      if (const auto pupil = tracer.object_pupil(*axis)) dark_area[w] = dark_pupil_share * pupil->area();
  });
  std::atomic<std::size_t> done{0};
  std::vector<std::vector<char>> lit(wavelengths, std::vector<char>(places, 0));
  parallel_for(entries, [&](std::size_t i) {
    const std::size_t w = i / places, place = i % places, entry = table.index(place, w);
    if (const auto& object = seen[w][place]) {
      frame.object_x[entry] = object->object[0];
      frame.object_y[entry] = object->object[1];
      lit[w][place] =
          fill_place(lens, options, table.wavelengths_nm[w], dark_area[w], object->object, table, entry);
    }
    if (progress) progress(static_cast<double>(++done) / static_cast<double>(entries), "lens data table");
  });
  for (std::size_t w = 0; w < wavelengths; ++w) extend_into_darkness(w, lit[w], table);
}

}  // namespace petzval
