// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_PROGRESS_HPP
#define PULSECAST_BASE_PROGRESS_HPP

#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

#include <pulsecast/base/tick.hpp>

namespace PULSECAST_NAMESPACE {

/// Progress of a run.
struct Progress {
  PulseIndex done = 0;       ///< pulse slots delivered to the sinks
  PulseIndex total = 0;      ///< pulse slots in the run
  std::uint64_t echoes = 0;  ///< echoes delivered to the sinks
  double seconds = 0;        ///< time since the start of the run [s]
};

/// Function that is called with the `Progress` of a run, or none. Copies share the function.
// std::function and its header would be a fiftieth of the cost of a small program
class ProgressCallback {
 public:
  ProgressCallback() = default;
  /// Takes a function, which may have state; none if it is null or an empty std::function.
  template <class Function>
  requires(!std::same_as<Function, ProgressCallback> && std::is_invocable_v<Function&, const Progress&>)
      ProgressCallback(Function function) {
    if constexpr (std::is_convertible_v<std::nullptr_t, Function>)
      if (function == nullptr) return;
    function_ = std::shared_ptr<void>(new Function(std::move(function)));
    call_ = [](void* f, const Progress& progress) { (*static_cast<Function*>(f))(progress); };
  }

  /// False without a function, which then must not be called.
  explicit operator bool() const noexcept { return call_ != nullptr; }
  void operator()(const Progress& progress) const { call_(function_.get(), progress); }

 private:
  std::shared_ptr<void> function_;
  void (*call_)(void*, const Progress&) = nullptr;
};

}  // namespace PULSECAST_NAMESPACE

#endif
