#pragma once
/// The words of [radiosity] that depend on the methods: what `method` may be, and which keys each reads. What a method
/// does is its row of host/radiosity/methods.cpp, in the same order.
#include <string>
#include <vector>

namespace pointgi {

struct RadiosityWords {
  const char* method;
  std::vector<const char*> keys; ///< of [radiosity] that this method alone, or with others, reads
};

/// A method a row. "auto", which chooses one, and "none", which exchanges no light, are not among them.
const std::vector<RadiosityWords>& radiosity_words();

/// What `radiosity.method` may be, the default first.
std::vector<std::string> radiosity_method_words();

/// Whether one method alone reads this key.
bool is_of_one_method(const std::string& key);

/// Every key that some method reads, once.
std::vector<std::string> radiosity_method_keys();

} // namespace pointgi
