// Errors in what the user gave us. Raised while loading, never inside the sampling loop.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace keyhole {

// A place in an input file. line and column count from 1; 0 means unknown.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

// what() is "file:line:column: message". The command prints it and ends with exit code 2.
class InputError : public std::runtime_error {
  public:
    InputError(SourceLocation where, const std::string& message);
    const SourceLocation& where() const { return where_; }

  private:
    SourceLocation where_;
};

// "valid names: a, b, c", with the candidate nearest to `found` named first when it is likely a typo
// ("did you mean 'reflectance'? valid names: ...").
std::string valid_names(const std::string& found, const std::vector<std::string>& names);

}  // namespace keyhole
