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
#include <set>
#include <utility>

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
  // An odd number, so that the axis has a place; from nine on 4 n + 1, so that every second and every fourth
  // make lattices too.
  constexpr int fewest = 5, step = 4;
  const auto places = [&](double of) {
    const int count = static_cast<int>(std::lround(options.frame_places * of / std::max(half[0], half[1])));
    if (count <= 2 * step) return std::max(fewest, count | 1);
    return (count + step - 2) / step * step + 1;
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

}  // namespace

FrameTable::FrameTable(const Lens& lens, const TableOptions& options)
    : lens_(lens),
      options_(completed(lens, options)),
      symmetry_(frame_symmetry(lens)),
      table_(blank_table(lens, options_)) {
  table_.frame = lay_frame(lens, options_);
  find_light();
  choose_windows();
}

void FrameTable::choose_windows() {
  // How far diffracted light is spread depends on where its window ends. Where some windows had to grow until
  // they hold enough, and others not, or corners of squares lie across a star's rays here and along them
  // there, what lies between would be told wrongly: all are round and grow alike.
  constexpr double above_wanted = 1e-3, growth = 1.25;
  constexpr int most_growths = 8;
  psf_options_ = psf_options_of(options_);
  psf_options_.exact_window = true;
  const double wanted = psf_options_.wanted_share + above_wanted;
  const std::size_t middle = table_.places() / 2, wavelength = table_.wavelengths_nm.size() / 2,
                    place = light_of(middle, wavelength), entry = table_.index(place, wavelength);
  PsfOptions once = psf_options_;
  once.wanted_share = 0;
  const double sign = towards_positive_image(lens_);
  const TurnedChief at(lens_, table_.wavelengths_nm[wavelength], options_,
                       {sign * table_.frame->object_x[entry], sign * table_.frame->object_y[entry]});
  for (int i = 0; i < most_growths && at.chief; ++i) {
    const std::optional<Psf> psf = point_spread(at.tracer, *at.chief, once);
    if (!psf || round_psf(*psf).captured >= wanted) break;
    once.margin *= growth;
  }
  psf_options_.margin = once.margin;
}

void FrameTable::find_light() {
  FramePlaces& frame = *table_.frame;
  const std::size_t places = frame.count(), wavelengths = table_.wavelengths_nm.size(),
                    entries = places * wavelengths;
  for (std::vector<double>* values :
       {&frame.object_x, &frame.object_y, &frame.psf_azimuth_deg, &table_.g_source_sr, &table_.g_sensor_sr})
    values->resize(entries);
  table_.psf.resize(entries);
  made_.resize(entries);
  lit_.assign(entries, 0);

  std::vector<double> dark_area(wavelengths, 0.0);
  parallel_for(wavelengths, [&](std::size_t w) {
    FieldTracer tracer(lens_, table_.wavelengths_nm[w], options_.clip);
    if (const auto axis = tracer.chief_ray(0))
      if (const auto pupil = tracer.object_pupil(*axis)) dark_area[w] = dark_pupil_share * pupil->area();
    const auto seen = seen_objects(lens_, options_, table_.wavelengths_nm[w], frame);
    for (std::size_t place = 0; place < places; ++place)
      if (seen[place]) {
        frame.object_x[table_.index(place, w)] = seen[place]->object[0];
        frame.object_y[table_.index(place, w)] = seen[place]->object[1];
        lit_[table_.index(place, w)] = 1;
      }
  });
  const auto twin = [&](std::size_t place) { return twin_of(symmetry_, frame, place); };
  parallel_for(entries, [&](std::size_t i) {
    const std::size_t w = i / places, place = i % places;
    if (twin(place).place == place && lit_[table_.index(place, w)] != 0)
      lit_[table_.index(place, w)] = illuminate(place, w, dark_area[w]) ? 1 : 0;
  });
  for (std::size_t w = 0; w < wavelengths; ++w) {
    for (std::size_t place = 0; place < places; ++place) {
      const FrameTwin of = twin(place);
      const std::size_t here = table_.index(place, w), there = table_.index(of.place, w);
      lit_[here] = lit_[there];
      table_.g_source_sr[here] = table_.g_source_sr[there];
      table_.g_sensor_sr[here] = table_.g_sensor_sr[there];
      frame.psf_azimuth_deg[here] = of.azimuth_deg(frame.psf_azimuth_deg[there]);
    }
    extend_into_darkness(w);
  }
}

bool FrameTable::illuminate(std::size_t place, std::size_t wavelength, double dark_area) {
  const std::size_t entry = table_.index(place, wavelength);
  const double sign = towards_positive_image(lens_);
  const Vector2 object{sign * table_.frame->object_x[entry], sign * table_.frame->object_y[entry]};
  TurnedChief at(lens_, table_.wavelengths_nm[wavelength], options_, object);
  if (!at.chief) return false;
  const auto lit = at.tracer.object_pupil(*at.chief);
  if (!lit || !(lit->area() > dark_area)) return false;
  at.tracer.set_losses(options_.losses);
  const std::optional<double> area = object_area(at);
  if (!area) return false;
  table_.g_source_sr[entry] = *area * at.tracer.object_flux(*at.chief);
  table_.g_sensor_sr[entry] = at.tracer.g_sensor_sr(*at.chief);
  // A PSF's t points away from the axis, in axes turned with the field: the other way where the image lies
  // there.
  const double half_turn = at.chief->image_height_mm < 0 ? 180 : 0;
  double azimuth = azimuth_of(object) + half_turn;
  if (azimuth > 180) azimuth -= 360;
  table_.frame->psf_azimuth_deg[entry] = azimuth;
  return true;
}

void FrameTable::make_psf(std::size_t place, std::size_t wavelength) {
  const std::size_t entry = table_.index(place, wavelength);
  const double sign = towards_positive_image(lens_);
  TurnedChief at(lens_, table_.wavelengths_nm[wavelength], options_,
                 {sign * table_.frame->object_x[entry], sign * table_.frame->object_y[entry]});
  at.tracer.set_losses(options_.losses);
  const std::optional<SmoothPupil> pupil =
      at.tracer.tracer().is_centred() ? fit_pupil(at.tracer, *at.chief) : std::nullopt;
  std::optional<Psf> psf;
  if (pupil) psf = point_spread(*pupil, psf_options_);
  if (!psf) psf = point_spread(at.tracer, *at.chief, psf_options_);
  // A fitted pupil knows its corners and so its flux better than a boundary of azimuths does.
  if (pupil) table_.g_source_sr[entry] *= pupil->flux / at.tracer.object_flux(*at.chief);
  if (psf) made_[entry] = round_psf(*psf);
}

std::size_t FrameTable::light_of(std::size_t place, std::size_t wavelength) const {
  const OutwardOrder outward(*table_.frame);
  while (lit_[table_.index(place, wavelength)] == 0) {
    const std::size_t inner = outward.inner(place);
    if (inner == place)
      throw InputError(
          fmt::format("{}: no ray passes the stop in the middle of the frame at {:g} nm; check stop "
                      "and clear apertures",
                      table_.lens_name, table_.wavelengths_nm[wavelength]));
    place = inner;
  }
  return place;
}

void FrameTable::extend_into_darkness(std::size_t wavelength) {
  FramePlaces& frame = *table_.frame;
  const OutwardOrder outward(frame);
  for (const std::size_t place : outward.order()) {
    const std::size_t here = table_.index(place, wavelength);
    if (lit_[here] != 0) continue;
    frame.psf_azimuth_deg[here] =
        frame.psf_azimuth_deg[table_.index(light_of(place, wavelength), wavelength)];
    const std::size_t inner = outward.inner(place), next = table_.index(inner, wavelength),
                      further = table_.index(outward.inner(inner), wavelength);
    frame.object_x[here] = 2 * frame.object_x[next] - frame.object_x[further];
    frame.object_y[here] = 2 * frame.object_y[next] - frame.object_y[further];
    table_.g_source_sr[here] = table_.g_sensor_sr[here] = 0;
  }
}

void FrameTable::add_psfs(std::span<const std::size_t> places, std::span<const std::size_t> wavelengths,
                          const ProgressCallback& progress) {
  const FramePlaces& frame = *table_.frame;
  std::set<std::pair<std::size_t, std::size_t>> missing;  // wavelength and place, each with its own PSF
  for (const std::size_t w : wavelengths)
    for (const std::size_t place : places) {
      const std::size_t twin = twin_of(symmetry_, frame, light_of(place, w)).place;
      if (made_[table_.index(twin, w)].size == 0) missing.emplace(w, twin);
    }
  const std::vector<std::pair<std::size_t, std::size_t>> order(missing.begin(), missing.end());
  std::atomic<std::size_t> done{0};
  parallel_for(order.size(), [&](std::size_t i) {
    make_psf(order[i].second, order[i].first);
    if (progress)
      progress(static_cast<double>(++done) / static_cast<double>(order.size()), "lens data table");
  });
  for (const std::size_t w : wavelengths)
    for (const std::size_t place : places) {
      const FrameTwin twin = twin_of(symmetry_, frame, light_of(place, w));
      const Psf& made = made_[table_.index(twin.place, w)];
      if (made.size == 0)
        throw InputError(fmt::format("{}: no ray passes at {} and {:g} nm", table_.lens_name,
                                     frame.name(twin.place), table_.wavelengths_nm[w]));
      const std::size_t here = table_.index(place, w);
      table_.psf[here] = twin.mirrored() ? mirrored_psf(made) : made;
      if (lit_[here] != 0) table_.g_source_sr[here] = table_.g_source_sr[table_.index(twin.place, w)];
    }
}

void FrameTable::remove_psf(std::size_t place, std::size_t wavelength) {
  table_.psf[table_.index(place, wavelength)] = {};
}

LensDataTable FrameTable::finished() && {
  table_.validate();
  return std::move(table_);
}

}  // namespace petzval
