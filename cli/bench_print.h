// What dreampm bench prints: a measurement with the machine that it was made on, as text or JSON.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/bench.h"

namespace dreampm::cli {

/// Adds the facts that every measurement has to name.
nlohmann::ordered_json with_machine(const nlohmann::ordered_json& more);
std::string machine_text();
/// Returns the line about the device that a backend runs on, or an empty text.
std::string device_text(const BenchBackend& choice);

/// `ceilings`: of the processors that the step was measured on; none of a device.
void print_step(const StepBenchResult& result, const std::optional<Ceilings>& ceilings, bool json);

/// `shrink`: what the lengths of scenes were divided by. `device`: as device_text().
void print_rows(const std::vector<BenchRow>& rows, int shrink, bool json, const std::string& device = {});

/// Measures a table, and prints each row as it comes. `measure` calls what it gets with every row.
using EachRow = std::function<void(const BenchRow&)>;
using MeasureTable = std::function<std::vector<BenchRow>(const EachRow&)>;
void print_table(int shrink, const std::string& device, bool json, const MeasureTable& measure);

}  // namespace dreampm::cli
