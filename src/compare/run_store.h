// The runs of a comparison in its folder: images and records, and whether they are still runs of the same thing.
//
//     FOLDER/runs/ENTRY/run-3.json       the record, written last: with it the run is complete
//     FOLDER/runs/ENTRY/run-3.exr        the image
//     FOLDER/runs/ENTRY/run-3-1of8.exr   the image after an eighth of the run
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/render.h"

namespace keyhole {

// A run after 1 / part of its length.
struct RunPart {
    int part = 1;
    double seconds = 0, cpu_seconds = 0;
    std::uint64_t mutations = 0;  // or samples
};

struct RunRecord {
    std::uint64_t seed = 0;
    std::vector<RunPart> parts;  // in the order of time; the last is the whole run
    double mutations_per_second = 0;
    RenderStatistics statistics;
};

class RunStore {
  public:
    // `identity`: everything that makes the runs of this entry what they are, as an object; stored with each.
    RunStore(const std::string& folder, const std::string& entry, nlohmann::json identity);

    // Runs are numbered from 1. What is different from `identity` in a run that is there; empty: nothing.
    std::vector<std::string> differences(int run) const;
    bool has(int run) const;
    RunRecord record(int run) const;
    Image image(int run, int part) const;

    void write_image(int run, int part, const Image& image, const WriteOptions& options) const;
    void write_record(int run, const RunRecord& record) const;

    // Deletes all runs of the entry.
    void discard() const;

    // Relative to the comparison's folder.
    std::string image_name(int run, int part) const;

  private:
    std::string record_file(int run) const;

    std::string folder_, entry_folder_;  // the second relative to the first
    nlohmann::json identity_;
};

}  // namespace keyhole
