// run.json: what is read is written and read again.
#include "dreampm/io/run_record.h"

#include "one_input.h"

using namespace dreampm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_one(size, 2000, [&] {
    const std::string text = RunRecord::from_json(std::string(fuzz::text_of(data, size)), fuzz::input_name).to_json();
    if (RunRecord::from_json(text, fuzz::input_name).to_json() != text)
      fuzz::fail("it is written in two ways:\n" + text);
  });
  return 0;
}
