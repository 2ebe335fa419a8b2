// step_calls.h - the calls that ODE's step is made of, for a world that has one thread: each is made where it is asked for, or where the
// last one that it waits for ends. ODE's own implementation for one thread puts them in a list and picks them from there, which costs
// more than a sixth of a step of two free bodies.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace traction::sim {

class StepCalls {
  public:
    void serve(dWorldID world); // from now on; must outlive the world

  private:
    struct Call {
        int *fault = nullptr; // set where it or one that it waited for failed
        std::size_t waits = 0;
        Call *then = nullptr; // waits for this one
        dThreadedCallFunction *function = nullptr;
        void *context = nullptr;
        dcallindex_t index = 0;
        bool failed = false, made = false;
    };
    static const dThreadingFunctionsInfo &functions();
    void make_more();
    void run(Call *call);
    std::vector<std::unique_ptr<Call>> all_;
    Call *free_ = nullptr; // linked by `then`
};

} // namespace traction::sim
