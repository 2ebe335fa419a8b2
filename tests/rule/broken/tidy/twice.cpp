// Used after it was moved: tidy finds it in C++ files that it reads together.
#include <string>
#include <utility>

std::string twice(std::string word) {
    const std::string kept = std::move(word);
    return kept + word;
}
