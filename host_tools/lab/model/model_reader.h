// model_reader.h - a model file's numbers and tables, with the file's name carried along, so that every message can say where.
#pragma once

#include "model.h"
#include "model_keys.h"

#include <toml++/toml.h>

#include <span>
#include <string>
#include <vector>

namespace traction::lab {

std::string number_text(double value);

// All throw ModelError: file, line, key, what is wrong, the mend.
struct ModelReader {
    std::string file;

    [[noreturn]] void fail(const toml::node &node, const std::string &key, const std::string &wrong, const std::string &mend) const;
    double number(const toml::node &node, const std::string &key) const;
    // What is written there and nothing else: `fallback` where the key is absent, never where it holds something of another kind.
    std::string text(const toml::table &source, const std::string &where, const char *key, const std::string &fallback) const;
    bool flag(const toml::table &source, const std::string &where, const char *key, bool fallback) const;

    // A number, or a table { value, unit, min, max, prior, each_wheel, fixed, source, low, high }.
    void parameter(const toml::node &node, const std::string &key, Parameter &p) const;

    // Fills `into` from the keys of the table that are in `known`; complains of others unless they are in `also`.
    void table(const toml::table &source, const std::string &where, std::span<const ModelKey> known, Parameters &into,
               const std::vector<std::string> &also, const std::string &prefix = "") const;

  private:
    std::string text_of(const toml::node &node, const std::string &path) const;
    bool flag_of(const toml::node &node, const std::string &path) const;
    void check_unit(const toml::node &item, const std::string &path, Parameter &p) const;
};

} // namespace traction::lab
