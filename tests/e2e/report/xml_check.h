// xml_check.h - a strict reader of XML 1.0 without DTD: says what is wrong with a text, or nothing.
#pragma once

#include <cctype>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace traction::test {

class XmlCheck {
  public:
    explicit XmlCheck(std::string_view text) : text_(text) {}

    // "" when well formed, otherwise what and where.
    std::string fault() {
        while (at_ < text_.size() && fault_.empty()) {
            if (text_[at_] == '<')
                element();
            else
                character_data();
        }
        if (fault_.empty() && !open_.empty()) fail("not closed: " + open_.back());
        if (fault_.empty() && roots_ != 1) fail(std::to_string(roots_) + " root elements");
        return fault_;
    }
    // How often an element of this name was met, and all attribute values of this name.
    std::multiset<std::string> elements;
    std::vector<std::string> values;

  private:
    void fail(const std::string &what) {
        if (fault_.empty()) fault_ = what + " at byte " + std::to_string(at_);
    }
    bool allowed(char c) const { return static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t' || c == '\r'; }

    void reference() { // at '&'
        static const std::set<std::string_view> known{"amp", "lt", "gt", "quot", "#39"};
        const std::size_t end = text_.find(';', at_);
        if (end == std::string_view::npos || known.count(text_.substr(at_ + 1, end - at_ - 1)) == 0) return fail("unknown reference");
        at_ = end + 1;
    }
    void character_data() {
        const char c = text_[at_];
        if (c == '&') return reference();
        if (!allowed(c)) return fail("forbidden character");
        if (open_.empty() && std::isspace(static_cast<unsigned char>(c)) == 0) return fail("text outside the root");
        ++at_;
    }
    std::string name() {
        const std::size_t from = at_;
        while (at_ < text_.size() &&
               (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '-' || text_[at_] == ':' || text_[at_] == '_'))
            ++at_;
        if (at_ == from) fail("a name was expected");
        return std::string(text_.substr(from, at_ - from));
    }
    bool take(char c) {
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }
    bool skip_space() {
        const std::size_t from = at_;
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
        return at_ != from;
    }
    void attribute(std::set<std::string> &seen) {
        const std::string key = name();
        if (!seen.insert(key).second) fail("attribute twice: " + key);
        if (!take('=') || !take('"')) return fail("attribute without a quoted value: " + key);
        const std::size_t from = at_;
        while (at_ < text_.size() && text_[at_] != '"' && fault_.empty()) {
            if (text_[at_] == '&')
                reference();
            else if (text_[at_] == '<' || !allowed(text_[at_]))
                fail("forbidden in an attribute");
            else
                ++at_;
        }
        values.emplace_back(text_.substr(from, at_ - from));
        if (!take('"')) fail("value not closed");
    }
    void element() {
        ++at_; // '<'
        if (take('/')) {
            const std::string closing = name();
            if (open_.empty() || open_.back() != closing) return fail("closes what is not open: " + closing);
            open_.pop_back();
            if (!take('>')) fail("'>' was expected");
            return;
        }
        const std::string opening = name();
        elements.insert(opening);
        if (open_.empty()) ++roots_;
        std::set<std::string> seen;
        while (fault_.empty()) {
            const bool space = skip_space();
            if (take('/')) {
                if (!take('>')) fail("'>' was expected");
                return;
            }
            if (take('>')) return open_.push_back(opening);
            if (!space) return fail("a space was expected");
            attribute(seen);
        }
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::vector<std::string> open_;
    int roots_ = 0;
    std::string fault_;
};

} // namespace traction::test
