// mutant.h - the switch of a mutated source: all faults stand in one program, at most one is awake (TRACTION_MUTANT=N).
//
// With TRACTION_MUTANT_REACHED=FILE the program writes which of them it came by.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <vector>

namespace traction::mutant {

class Switch {
  public:
    bool on(std::size_t number) {
        if (reached_file_ == nullptr) return number == awake_;
        if (number >= reached_.size()) reached_.resize(number + 1, false);
        reached_[number] = true;
        return false;
    }
    ~Switch() {
        std::FILE *file = reached_file_ == nullptr ? nullptr : std::fopen(reached_file_, "w");
        for (std::size_t i = 0; file != nullptr && i < reached_.size(); ++i)
            if (reached_[i]) std::fprintf(file, "%zu\n", i);
        if (file != nullptr) std::fclose(file);
    }

  private:
    const char *reached_file_ = std::getenv("TRACTION_MUTANT_REACHED");
    std::size_t awake_ = std::getenv("TRACTION_MUTANT") == nullptr ? 0 : std::strtoul(std::getenv("TRACTION_MUTANT"), nullptr, 10);
    std::vector<bool> reached_;
};

inline Switch &the_switch() {
    static Switch one;
    return one;
}
inline bool on(std::size_t number) { return the_switch().on(number); }

} // namespace traction::mutant
