// keys.h - reads the keys of a TOML table with their schema: type, range, allowed words; and refuses what the schema lacks.
#pragma once

#include "scenario_error.h"

#include <toml++/toml.h>

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace traction::sim {

struct Range {
    double low, high; // both allowed
};

class Keys {
  public:
    // `path` is the table's name in messages: "ground", "drive[2]"; empty for the top of the file.
    Keys(const toml::table &table, std::string file, std::string path);

    bool has(std::string_view key);
    double number(std::string_view key, double fallback, Range range);
    double need_number(std::string_view key, Range range);
    long integer(std::string_view key, long fallback, long low, long high);
    bool flag(std::string_view key, bool fallback);
    std::string text(std::string_view key, std::string_view fallback);
    // One of `words`; the index of the word.
    std::size_t word(std::string_view key, std::string_view fallback, std::span<const std::string_view> words);
    const toml::table *table(std::string_view key);
    const toml::array *array(std::string_view key);  // any array
    const toml::array *tables(std::string_view key); // an array of tables: [[key]]
    const toml::node *node(std::string_view key);    // marks the key as known

    // Unknown keys are mistakes: call when every known key has been asked for.
    void finish() const;

    double number_of(const toml::node &node, std::string_view key, Range range) const;
    [[noreturn]] void fail(std::string_view key, const std::string &what_is_wrong, const std::string &mend) const;
    [[noreturn]] void fail_at(const toml::node &node, std::string_view key, const std::string &what_is_wrong,
                              const std::string &mend) const;
    std::string full_name(std::string_view key) const;
    const std::string &file() const { return file_; }

  private:
    const toml::table &table_;
    std::string file_, path_;
    std::set<std::string, std::less<>> known_;
};

} // namespace traction::sim
