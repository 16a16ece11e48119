// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_SURFACE_LAW_HPP
#define PULSECAST_MATERIAL_SURFACE_LAW_HPP

#include <memory>
#include <span>

#include <pulsecast/hit.hpp>
#include <pulsecast/material/lambert.hpp>

namespace PULSECAST_NAMESPACE {

/// Any law of scattered light as a value; copies share it. A program has the code of the laws that
/// it makes. The default, Lambert's, and `DirectionIndependent` are linear, and cost no call.
class SurfaceLaw {
 public:
  /// Law behind a table of functions: members of the concepts, with defaults for what a law lacks.
  class Model {
   public:
    virtual ~Model() = default;
    virtual void validate() const {}
    virtual double backscatter(double cosine, const SurfaceLight& light) const noexcept = 0;
    virtual double scattered_share(double cosine, const SurfaceLight& light) const noexcept = 0;
    /// Sets what hits whose cosine is set scatter.
    virtual void scatter_at(std::span<Hit> hits, const SurfaceLight& light) const noexcept = 0;
    virtual double scattered(const Vec3&, const Vec3&, const Vec3&, const SurfaceLight&) const noexcept { return 0; }
    virtual std::optional<SampledDirection> sample(const Vec3&, const Vec3&, double, double) const noexcept {
      return std::nullopt;
    }

    double returned_share = 0, returned_half_angle = 0;         ///< of a law that `Retroreflects`
    bool reflects_interface = false, scatters_between = false;  ///< as of the concepts
  };

  SurfaceLaw() = default;
  /// Takes a law, as all constructors.
  SurfaceLaw(Lambert) noexcept {}  // NOLINT: implicit by purpose, as the next two
  /// As above.
  SurfaceLaw(DirectionIndependent) noexcept : cosine_(0), even_(1) {}  // NOLINT
  /// As above; one that is not a `ScatteringLaw` is an error that names the member.
  template <class Law>
  requires(!std::same_as<Law, SurfaceLaw> && detail::MeantAsLaw<Law>) SurfaceLaw(Law law)  // NOLINT
      : model_(std::make_shared<const ModelOf<Law>>(std::move(law))) {}

  /// @throws SettingError as `validate()` of the law, or if it breaks its laws at a white surface
  void validate() const {
    if (!model_) return;
    model_->validate();
    for (const double cosine : {0.0, 0.5, 1.0}) {
      require_not_negative("Material::law (backscatter)", model_->backscatter(cosine, 1e-6), "");
      require_within("Material::law (scattered_share)", model_->scattered_share(cosine, 1e-6), 0, 1, "");
    }
  }

  /// The law, if it is of a type; null otherwise.
  template <class Law>
  [[nodiscard]] const Law* get() const noexcept {
    static constexpr bool linear = std::same_as<Law, Lambert> || std::same_as<Law, DirectionIndependent>;
    if constexpr (linear) {
      static constexpr Law law{};
      return !model_ && (cosine_ > 0) == std::same_as<Law, Lambert> ? &law : nullptr;
    } else {
      const auto* of = dynamic_cast<const ModelOf<Law>*>(model_.get());
      return of ? &of->law : nullptr;
    }
  }
  /// Law of the backscatter; null for `reflectance * (cosine_share * cosine + even_share)`.
  [[nodiscard]] const Model* model() const noexcept { return model_.get(); }
  [[nodiscard]] double cosine_share() const noexcept { return cosine_; }  ///< 1 for Lambert's law, or 0
  [[nodiscard]] double even_share() const noexcept { return even_; }      ///< 1 for `DirectionIndependent`, or 0
  /// True of a law that `ScattersBetween`.
  [[nodiscard]] bool scatters_between() const noexcept { return !model_ || model_->scatters_between; }
  /// True of a law that `ReflectsInterface`.
  [[nodiscard]] bool reflects_interface() const noexcept { return model_ && model_->reflects_interface; }
  /// As of a law that `Retroreflects`; 0 of others.
  [[nodiscard]] double returned_share() const noexcept { return model_ ? model_->returned_share : 0; }
  [[nodiscard]] double returned_half_angle() const noexcept { return model_ ? model_->returned_half_angle : 0; }

 private:
  template <class Law>
  struct ModelOf final : Model {
    static_assert(detail::Backscatters<Law>,
                  "a law of scattered light needs the member: double backscatter(double cosine, "
                  "double wavelength or const SurfaceLight&) const noexcept");
    static_assert(detail::TellsShare<Law>,
                  "a law of scattered light needs the member: double scattered_share(double cosine, "
                  "double wavelength or const SurfaceLight&) const noexcept");
    static_assert(detail::BackscattersSurfaceLight<Law> == detail::TakesSurfaceLight<Law> &&
                      (!ScattersBetween<Law> || detail::ScattersSurfaceLight<Law> == detail::TakesSurfaceLight<Law>),
                  "all members of a law take the same: the wavelength, or a const SurfaceLight&");
    static_assert(detail::members_checked<Law, tag::Validated, tag::ScattersInLanes, tag::ScattersBetween,
                                          tag::SamplesDirections, tag::Retroreflects, tag::ReflectsInterface>);
    explicit ModelOf(Law l) : law(std::move(l)) {
      this->scatters_between = ScattersBetween<Law>;
      if constexpr (Retroreflects<Law>) {
        this->returned_share = law.returned_share();
        this->returned_half_angle = law.returned_half_angle();
      }
      if constexpr (ReflectsInterface<Law>) this->reflects_interface = true;
    }

    void validate() const override {
      if constexpr (Validated<Law>) law.validate();
    }
    double backscatter(double cosine, const SurfaceLight& light) const noexcept override {
      return law.backscatter(cosine, detail::taken_by<Law>(light));
    }
    double scattered_share(double cosine, const SurfaceLight& light) const noexcept override {
      return law.scattered_share(cosine, detail::taken_by<Law>(light));
    }
    void scatter_at(std::span<Hit> hits, const SurfaceLight& light) const noexcept override {
      const auto& in = detail::taken_by<Law>(light);
      constexpr std::size_t lanes = ScattersInLanes<Law> ? simd::lane_count : 1;
      if (hits.size() < lanes || lanes == 1) {
        for (Hit& hit : hits) {
          hit.backscatter = law.backscatter(hit.cos_incidence, in);
          hit.scattered_share = law.scattered_share(hit.cos_incidence, in);
        }
      } else if constexpr (lanes > 1) {
        for (std::size_t j = 0; j < hits.size(); j += lanes) {
          Hit* const block = &hits[std::min(j, hits.size() - lanes)];  // the last may overlap
          const auto cosine = [&](std::size_t k) { return block[k].cos_incidence; };
          const simd::Doubles values = law.backscatter(simd::generate(cosine), in);
#pragma GCC unroll 8
          for (std::size_t k = 0; k < lanes; ++k) {
            block[k].backscatter = values[k];
            block[k].scattered_share = law.scattered_share(block[k].cos_incidence, in);
          }
        }
      }
    }
    double scattered(const Vec3& in, const Vec3& out, const Vec3& normal,
                     const SurfaceLight& light) const noexcept override {
      if constexpr (ScattersBetween<Law>) return law.scattered(in, out, normal, detail::taken_by<Law>(light));
      return 0;
    }
    std::optional<SampledDirection> sample(const Vec3& in, const Vec3& normal, double u,
                                           double v) const noexcept override {
      if constexpr (SamplesDirections<Law>) return law.sample(in, normal, u, v);
      return std::nullopt;
    }

    Law law;
  };

  std::shared_ptr<const Model> model_{};
  double cosine_ = 1, even_ = 0;
};

}  // namespace PULSECAST_NAMESPACE

#endif
