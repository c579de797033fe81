// The parameters of one plugin, read by name and type; what was never asked for is reported.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/reader/document.h"

namespace keyhole {

// What reading a scene says besides errors.
struct Notes {
    bool lenient = false;  // unknown parameters are warnings
    std::vector<std::string> warnings, unused;
    std::set<const Element*> referenced;  // definitions that a <ref> in use names
};

// Where a number may lie.
struct Range {
    double low, high;
    bool open = false;  // without its ends

    // Lengths, intensities and the like stay where their squares and cubes are finite.
    static constexpr double largest = 1e15;
    static constexpr Range any() { return {-largest, largest}; }
    static constexpr Range positive() { return {1 / largest, largest}; }
    static constexpr Range not_negative() { return {0, largest}; }
    static constexpr Range unit() { return {0, 1}; }
};

class Properties {
  public:
    // A child of the plugin; `target` is what it stands for (a <ref> resolved).
    struct Child {
        const Element* given;
        const Element* target;
        std::string name;  // Mitsuba 3 spelling; empty: none
        bool read = false;
    };

    // Throws InputError for a parameter given twice and for unresolved references.
    Properties(const Element& plugin, const Document& document, Notes& notes);
    Properties(const Properties&) = delete;
    Properties& operator=(const Properties&) = delete;

    const Element& element() const { return plugin_; }
    std::string title() const;                      // "bsdf 'diffuse'"
    std::string of(const std::string& name) const;  // "parameter 'alpha' of bsdf 'roughconductor'"

    // The parameter, or null. It counts as read. All typed functions throw InputError at the parameter if it has
    // another type or lies outside the range, and at the plugin if it is required (no fallback) and missing.
    const Child* find(const std::string& name);
    const Child& require(const std::string& name);
    bool has(const std::string& name) const;

    std::optional<double> find_number(const std::string& name, Range range);
    double number(const std::string& name, Range range);
    double number(const std::string& name, Range range, double fallback);
    int integer(const std::string& name, int low, int high, int fallback);
    bool boolean(const std::string& name, bool fallback);
    std::optional<std::string> find_string(const std::string& name);
    std::string string(const std::string& name);
    // One of `valid`.
    std::string choice(const std::string& name, const std::vector<std::string>& valid, const std::string& fallback);
    std::optional<Vec3> find_vector(const std::string& name, const std::string& tag);  // tag: point or vector
    Affine transform(const std::string& name);
    Eigen::Matrix3d uv_transform(const std::string& name);

    // All children that are (or refer to) a plugin of this kind, in order, whatever their names.
    std::vector<const Child*> objects(const std::string& tag);
    // The only such child, or null. Throws InputError for two.
    const Child* object(const std::string& tag);
    const Child& require_object(const std::string& tag);

    // Parameters that are known and have no effect here: noted as such if they are given.
    void ignore(const std::vector<std::string>& names);

    // Throws InputError for the first child that was not read, listing all names asked for; with `lenient` each is a
    // warning. To be called when everything has been read.
    void finish();

    Notes& notes() { return notes_; }
    [[noreturn]] void fail(const Child& child, const std::string& message) const;

  private:
    void check_first(const Child& child) const;
    const std::string& value(const Child& child, const std::vector<std::string>& tags);

    const Element& plugin_;
    Notes& notes_;
    std::vector<Child> children_;
    std::vector<std::string> asked_;
};

}  // namespace keyhole
