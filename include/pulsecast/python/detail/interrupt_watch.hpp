// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_INTERRUPT_WATCH_HPP
#define PULSECAST_PYTHON_DETAIL_INTERRUPT_WATCH_HPP

#include <pybind11/pybind11.h>

#include <chrono>
#include <future>
#include <optional>
#include <stop_token>
#include <utility>

#include <pulsecast/base/namespace.hpp>

// hidden, as pybind11's own names, so that modules of different builds can coexist
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Lets Python handle its signals during work without the GIL, which it does on the main thread alone. A handler that
/// raises, as that of Ctrl-C, stops the work; one that does not, as that of `asyncio` at the first Ctrl-C, is called
/// meanwhile.
class InterruptWatch {
 public:
  explicit InterruptWatch(std::stop_source stopping) : stopping_(std::move(stopping)) {
    const pybind11::module_ threading = pybind11::module_::import("threading");
    on_main_ = threading.attr("current_thread")().is(threading.attr("main_thread")());
  }

  /// Calls `work()` on a thread of its own and handles signals on this one; on any but the main thread, simply calls
  /// it. Needs the GIL.
  template <class Work>
  void during(const Work& work) {
    const pybind11::gil_scoped_release free;
    if (!on_main_) return work();
    std::future<void> done = std::async(std::launch::async, work);
    const auto handle = [this] {
      const pybind11::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() == 0) return;
      raised_.emplace();
      stopping_.request_stop();
    };
    while (done.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) handle();
    handle();  // an interrupt too late to stop the work is still reported
    done.get();
  }

  /// True after Ctrl-C. Throws what another handler raised.
  [[nodiscard]] bool interrupted() const {
    if (raised_ && !raised_->matches(PyExc_KeyboardInterrupt)) throw pybind11::error_already_set(*raised_);
    return raised_.has_value();
  }

 private:
  std::stop_source stopping_;
  std::optional<pybind11::error_already_set> raised_{};  // by a handler
  bool on_main_ = false;
};

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
