#include "checkpoint.h"

#include <utility>

namespace traction::lab {

namespace {
thread_local std::function<void()> question;
} // namespace

CheckpointScope::CheckpointScope(std::function<void()> ask) : before_(std::exchange(question, std::move(ask))) {}
CheckpointScope::~CheckpointScope() { question = std::move(before_); }

void checkpoint() {
    if (question) question();
}

} // namespace traction::lab
