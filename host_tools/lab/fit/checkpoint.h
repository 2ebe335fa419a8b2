// checkpoint.h - lets whoever called the lab end a long computation: asked before every fit.
//
// One question per thread, so that two callers in two threads do not meet. What it throws goes through the lab to the caller; nothing
// is half done then but the answer.
#pragma once

#include <functional>

namespace traction::lab {

// While it lives, `ask` is called at every checkpoint of this thread.
class CheckpointScope {
  public:
    explicit CheckpointScope(std::function<void()> ask);
    ~CheckpointScope();
    CheckpointScope(const CheckpointScope &) = delete;
    CheckpointScope &operator=(const CheckpointScope &) = delete;

  private:
    std::function<void()> before_;
};

void checkpoint();

} // namespace traction::lab
