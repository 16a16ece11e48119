// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_INTERRUPT_WATCH_HPP
#define PULSECAST_PYTHON_DETAIL_INTERRUPT_WATCH_HPP

#include <pybind11/pybind11.h>

#include <atomic>
#include <csignal>

#include <pulsecast/base/namespace.hpp>

// hidden, as pybind11's own names, so that modules of different builds can coexist
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Records Ctrl-C during its life, where Python would notice it only later: on the main thread, which alone gets signals, and only if
/// Ctrl-C raises `KeyboardInterrupt`. The program's own handler, or none, stays as it is.
class InterruptWatch {
 public:
  InterruptWatch() {
    const pybind11::module_ threading = pybind11::module_::import("threading"), signal = pybind11::module_::import("signal");
    watching_ = threading.attr("current_thread")().is(threading.attr("main_thread")()) &&
                signal.attr("getsignal")(SIGINT).is(signal.attr("default_int_handler"));
    if (!watching_) return;
    seen() = false;
    before_ = PyOS_setsig(SIGINT, [](int) { seen() = true; });
  }
  ~InterruptWatch() {
    if (watching_) PyOS_setsig(SIGINT, before_);
  }
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  [[nodiscard]] bool interrupted() const noexcept { return watching_ && seen(); }

 private:
  [[nodiscard]] static std::atomic<bool>& seen() noexcept {
    static std::atomic<bool> interrupted = false;
    return interrupted;
  }

  bool watching_ = false;
  PyOS_sighandler_t before_ = nullptr;
};

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
