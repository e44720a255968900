// SPDX-License-Identifier: BSD-3-Clause
// Whether work that is under way shall end: asked by loops, answered by the callback of the Context they run
// in.
#pragma once

namespace petzval {

class Listener;

/// Asks the callbacks of the contexts that this thread works for (run_within()), each at most twenty times a
/// second. Cheap enough for every item of a loop; does nothing outside of any context. \throws Cancelled.
void check_stop();

/// Whom this thread works for; none outside of run_within().
Listener* current_listener();

/// While it lives, this thread works for the listener of the thread that began the loop.
class ListenerScope {
 public:
  explicit ListenerScope(Listener* listener);
  ~ListenerScope();
  ListenerScope(const ListenerScope&) = delete;
  ListenerScope& operator=(const ListenerScope&) = delete;

 private:
  Listener* before_;
};

}  // namespace petzval
