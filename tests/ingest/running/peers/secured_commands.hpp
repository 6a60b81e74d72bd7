// The commands of a secured peer, whatever its middleware; words are as in words.hpp:
//   participant NAME DOMAIN SEAT FOLDER   writer NAME TOPIC PARTITION   reader NAME TOPIC PARTITION   received NAME
// After each it prints a line that begins with "done": with "yes" or "no" where the middleware may refuse, or with the
// topics of which data came. FOLDER has the files of an enclave, as sros2 names them; without it there is no security.
// A writer writes one sample, which readers that come later get too.
#pragma once
#include <cstdio>
#include <iostream>
#include <map>
#include <sstream>

#include "words.hpp"

template <class Secured, class... More>
int serve(FILE* answers, const More&... more) {
  std::map<std::string, Secured> all;
  const auto says = [](bool it) { return it ? " yes" : " no"; };
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    const std::string command = word(words), name = word(words);
    std::string answer;
    if (command == "participant") {
      const int domain = std::stoi(word(words)), seat = std::stoi(word(words));
      const std::string folder = word(words);
      const auto one = all.emplace(std::piecewise_construct, std::forward_as_tuple(name),
                                   std::forward_as_tuple(domain, seat, folder, more...));
      answer = says(one.first->second.there());
    } else if (command == "writer" || command == "reader") {
      const std::string topic = word(words), partition = word(words);
      Secured& one = all.at(name);
      answer = says(one.there() && (command == "writer" ? one.writer(topic, partition) : one.reader(topic, partition)));
    } else if (command == "received") {
      answer = all.at(name).received();
    } else {
      std::cerr << "unknown command: " << command << std::endl;
      return 2;
    }
    std::fprintf(answers, "done%s\n", answer.c_str());
    std::fflush(answers);
  }
  return 0;
}
