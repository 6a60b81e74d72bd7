// The words of a command, for peers of every middleware.
#pragma once
#include <istream>
#include <string>

// The next word of a line: %XX stands for a byte, and - for nothing.
static std::string word(std::istream& line) {
  std::string raw, text;
  line >> raw;
  if (raw == "-") return "";
  for (size_t i = 0; i < raw.size(); i++) {
    if (raw[i] == '%' && i + 2 < raw.size()) {
      text += static_cast<char>(std::stoi(raw.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      text += raw[i];
    }
  }
  return text;
}
