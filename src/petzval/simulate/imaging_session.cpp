// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/simulate/imaging_memory.h>
#include <petzval/simulate/imaging_session.h>

#include <utility>
#include <variant>

namespace petzval {

namespace {

/// All that an image depends on, but what is the same in the whole session.
struct ImageKey {
  std::string lens = {};
  double horizontal_angle_deg = 0;
  std::optional<double> distance_m = {};
  int columns = 0, rows = 0;
  double pitch_um = 0;
  Photosite photosite = {};

  ImageKey() = default;
  ImageKey(const ImagePlan& plan, std::string lens_key)
      : lens(std::move(lens_key)),
        horizontal_angle_deg(plan.scene.horizontal_angle_deg()),
        distance_m(plan.scene.distance_m()),
        columns(plan.frame.columns),
        rows(plan.frame.rows),
        pitch_um(plan.frame.pitch_um),
        photosite(plan.options.imaging.photosite) {}
  bool operator==(const ImageKey&) const = default;
};

}  // namespace

struct ImagingSession::Kept {
  struct Formed {
    ImageKey key;
    SpectralImage light;
    ImageReport report;
  };

  std::variant<SceneRequest, Scene> scene;
  ImageOptions options;
  ImagingMemory memory = {};
  std::optional<Formed> last = {};

  ImagePlan plan(Optics optics, const Context& context) {
    if (const auto* request = std::get_if<SceneRequest>(&scene))
      return plan_image(*request, std::move(optics), options, context, memory);
    return plan_image(std::get<Scene>(scene), std::move(optics), options, context, memory);
  }

  const Formed& form(const ImagePlan& plan, const Context& context) {
    ImageKey key(plan, memory.lens_key());
    if (last && !key.lens.empty() && last->key == key) {
      for (const std::string& line : last->report.imaging.notes) send_note(context, line);
      return *last;
    }
    last.reset();
    ImageReport report;
    SpectralImage light = petzval::image(plan, context, &report);
    ++memory.work.images_formed;
    return last.emplace(Formed{std::move(key), std::move(light), std::move(report)});
  }
};

ImagingSession::ImagingSession(SceneRequest scene, ImageOptions options)
    : kept_(std::make_unique<Kept>(Kept{std::move(scene), std::move(options)})) {}

ImagingSession::ImagingSession(Scene scene, ImageOptions options)
    : kept_(std::make_unique<Kept>(Kept{std::move(scene), std::move(options)})) {}

ImagingSession::~ImagingSession() = default;
ImagingSession::ImagingSession(ImagingSession&&) noexcept = default;
ImagingSession& ImagingSession::operator=(ImagingSession&&) noexcept = default;

const ImagingSession::Work& ImagingSession::work() const {
  return kept_->memory.work;
}

SpectralImage ImagingSession::image(Optics optics, const Context& context, ImageReport* report) {
  ImagePlan plan = kept_->plan(std::move(optics), context);
  try {
    const Kept::Formed& formed = kept_->form(plan, context);
    if (report != nullptr) *report = formed.report;
    kept_->memory.give_back(plan);
    return formed.light;
  } catch (...) {
    kept_->memory.give_back(plan);
    throw;
  }
}

}  // namespace petzval
