#include "step_calls.h"

namespace traction::sim {

namespace {

// ODE names these types and leaves what they are to the implementation.
StepCalls *of(dThreadingImplementationID id) { return reinterpret_cast<StepCalls *>(id); }

// One thread locks nothing and waits for nothing: an address that is not null is all that ODE wants of them.
int nothing = 0;

} // namespace

void StepCalls::serve(dWorldID world) {
    dWorldSetStepThreadingImplementation(world, &functions(), reinterpret_cast<dThreadingImplementationID>(this));
}

void StepCalls::make_more() {
    all_.push_back(std::make_unique<Call>());
    free_ = all_.back().get();
}

// Makes a call that waits for nothing, then those that waited for it alone. One that gave itself something to wait for ends later.
void StepCalls::run(Call *call) {
    while (call != nullptr) {
        if (!call->made) {
            call->made = true;
            if (call->function(call->context, call->index, reinterpret_cast<dCallReleaseeID>(call)) == 0) call->failed = true;
            if (call->waits > 0) return;
        }
        if (call->failed && call->fault != nullptr) *call->fault = 1;
        Call *const then = call->then;
        if (then != nullptr) then->failed = then->failed || call->failed;
        call->then = free_;
        free_ = call;
        call = then != nullptr && --then->waits == 0 ? then : nullptr;
    }
}

const dThreadingFunctionsInfo &StepCalls::functions() {
    static const dThreadingFunctionsInfo info = [] {
        dThreadingFunctionsInfo f{};
        f.struct_size = sizeof f;
        f.alloc_mutex_group = [](dThreadingImplementationID, dmutexindex_t, const char *const *) {
            return reinterpret_cast<dMutexGroupID>(&nothing);
        };
        f.free_mutex_group = [](dThreadingImplementationID, dMutexGroupID) {};
        f.lock_group_mutex = [](dThreadingImplementationID, dMutexGroupID, dmutexindex_t) {};
        f.unlock_group_mutex = [](dThreadingImplementationID, dMutexGroupID, dmutexindex_t) {};
        f.alloc_call_wait = [](dThreadingImplementationID) { return reinterpret_cast<dCallWaitID>(&nothing); };
        f.reset_call_wait = [](dThreadingImplementationID, dCallWaitID) {};
        f.free_call_wait = [](dThreadingImplementationID, dCallWaitID) {};
        f.post_call = [](dThreadingImplementationID id, int *fault, dCallReleaseeID *releasee, ddependencycount_t waits,
                         dCallReleaseeID then, dCallWaitID, dThreadedCallFunction *function, void *context, dcallindex_t index,
                         const char *) {
            StepCalls &calls = *of(id);
            if (calls.free_ == nullptr) calls.make_more();
            Call &call = *calls.free_;
            calls.free_ = call.then;
            call = {fault, waits, reinterpret_cast<Call *>(then), function, context, index, false, false};
            if (releasee != nullptr) *releasee = reinterpret_cast<dCallReleaseeID>(&call);
            if (waits == 0) calls.run(&call);
        };
        f.alter_call_dependencies_count = [](dThreadingImplementationID id, dCallReleaseeID target, ddependencychange_t change) {
            Call &call = *reinterpret_cast<Call *>(target);
            call.waits += static_cast<std::size_t>(change);
            if (call.waits == 0) of(id)->run(&call);
        };
        f.wait_call = [](dThreadingImplementationID, int *status, dCallWaitID, const dThreadedWaitTime *, const char *) {
            if (status != nullptr) *status = 1; // it has been made
        };
        f.retrieve_thread_count = [](dThreadingImplementationID) { return 1u; };
        f.preallocate_resources_for_calls = [](dThreadingImplementationID, ddependencycount_t) { return 1; };
        return f;
    }();
    return info;
}

} // namespace traction::sim
