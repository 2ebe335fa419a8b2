#include "ulog_format.h"

#include <map>

namespace traction::log {

std::uint64_t little_endian(std::string_view bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8u | static_cast<std::uint8_t>(bytes[i]);
    return value;
}

std::optional<std::vector<UlogField>> ulog_fields(std::string_view format) {
    static const std::map<std::string_view, std::size_t> sizes{{"int8_t", 1},   {"uint8_t", 1}, {"int16_t", 2},  {"uint16_t", 2},
                                                               {"int32_t", 4},  {"float", 4},   {"uint32_t", 4}, {"int64_t", 8},
                                                               {"uint64_t", 8}, {"double", 8},  {"bool", 1},     {"char", 1}};
    std::vector<UlogField> fields;
    std::size_t offset = 0;
    while (!format.empty()) {
        const std::size_t end = format.find(';'), blank = format.find(' ');
        if (end == std::string_view::npos || blank == std::string_view::npos || blank > end) return {};
        std::string_view type = format.substr(0, blank);
        UlogField field;
        if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
            field.count = 0;
            for (const char c : type.substr(bracket + 1, type.size() - bracket - 2)) {
                if (c < '0' || c > '9' || field.count > 6553) return {};
                field.count = field.count * 10 + static_cast<std::size_t>(c - '0');
            }
            type = type.substr(0, bracket);
        }
        const auto known = sizes.find(type);
        if (known == sizes.end()) return {};
        field.at = offset;
        field.size = known->second;
        field.type = known->first;
        field.name = format.substr(blank + 1, end - blank - 1);
        offset += field.size * field.count;
        fields.push_back(std::move(field));
        format.remove_prefix(end + 1);
    }
    return fields;
}

UlogStop for_each_ulog_message(std::string_view file, const std::function<void(char, std::string_view)> &each) {
    std::size_t at = ulog_head_bytes;
    while (at + 3 <= file.size()) {
        const auto size = static_cast<std::size_t>(little_endian(file.substr(at, 2)));
        const char kind = file[at + 2];
        if (at + 3 + size > file.size()) break;
        if (std::string_view("BFIMPQADLCSRO").find(kind) == std::string_view::npos) return {UlogEnd::no_message, at};
        each(kind, file.substr(at + 3, size));
        at += 3 + size;
    }
    return {at < file.size() ? UlogEnd::within_a_message : UlogEnd::whole, at};
}

} // namespace traction::log
