# A thin door in front of CMake and Ninja. Any of these may be typed first on a fresh Debian 12 machine:
#   make            set-up and build; the command is build/dreampm
#   make demo       the same, then the Stanford dragon falls into water: out/dragon-splatting-preview/*.mp4
#   make boxes      the same, then a spring carries boxes over an edge: out/drifting-boxes-preview/*.mp4
#   make fill       the same, then a tap fills a hollow dragon: out/flow-in-the-dragon-preview/*.mp4
#   make play       the same, then the playground in a window; PLAY=honey-coil: another story or scene
#   make cuda       the kernels for NVIDIA GPUs, by a compiler that pip fetches (0.5 GB): docs/guide/gpu.md
#   make install    the same, then command and library into PREFIX, by default /usr/local; DESTDIR=FOLDER: below FOLDER
#   make package    the same, then a .deb and a .tar.gz in build/packages/
#   make test       the same, then every test
#   make validate   the solver against experiments and exact solutions, in a minute or two
#   make docs       pages of the public headers, by Doxygen: build/docs/html
#   make tidy       clang-tidy over the files that changed since the last commit; TIDY=all: over all, which takes long
#   make check      only the checks of the tree: layers, links, words, width, format
#   make format     rewrites the C++ files in the project's format, and wraps prose
#   make test-asan    core modules by clang under sanitizers; make test-clang: without them, the solver too
#   make test-neon    the ARM kernels by a cross compiler, their laws in an emulator: two minutes
#   make fuzz       readers of files under libFuzzer, a minute each; TARGETS="stl ply", SECONDS=5 or RUNS=1000000, SEED=1
#   make test-tsan    what works on several threads under ThreadSanitizer, with a TBB built for it: a quarter of an hour
#   make test-python  the Python package, its tests, guide and examples: pip fetches nanobind, numpy and what they need
#   make wheel      a wheel of the Python package that brings its libraries along, in build/wheels/
#   make blender      the extension for Blender 4.2 and newer: build/dreampm-blender-VERSION.zip
#   make test-blender   the extension within Blender: pip fetches bpy, 0.4 GB, once
#   make test-gpu   the kernels for GPUs by nvcc, which pip fetches, and by clang for CUDA and HIP; it needs no GPU
#   make test-farm    jobs of Open Job Description, run by openjd-cli, which pip fetches
#   make test-slurm   jobs of Slurm on a cluster of one machine: half a minute, as root
#   make test-dragon    fetches the dragon and checks its points at full resolution: a minute or two
# Variables: CXX (default g++), TEST_JOBS (tests at once, default 2), MODEL (make demo MODEL=FILE or asset:knot: in place
# of the dragon).
.DEFAULT_GOAL := all
.PHONY: all cuda test-gpu install package docs tidy demo boxes fill play test validate test-dragon test-asan test-tsan test-clang test-neon fuzz test-python wheel blender test-blender test-farm test-slurm check format clean
# A half-written stamp or build.ninja must not count as made.
.DELETE_ON_ERROR:

# The environment of make is passed down, and some machines put another python or compiler in front of Debian's.
ifeq ($(origin CXX),default)
CXX := g++
endif
PYTHON := /usr/bin/python3
TEST_JOBS ?= 2
CONFIGURE = cmake -DPython3_EXECUTABLE=$(PYTHON)
NINJA = ninja -j$(shell nproc)
CTEST = ctest --output-on-failure -j$(TEST_JOBS)

all: build/build.ninja
	@$(NINJA) -C build

# What lies where is settled when it is configured: below /usr as Debian wants it.
PREFIX := /usr/local
install: all
	@grep -qxF 'CMAKE_INSTALL_PREFIX:PATH=$(PREFIX)' build/CMakeCache.txt || \
	  { cmake build -DCMAKE_INSTALL_PREFIX='$(PREFIX)' && $(NINJA) -C build; }
	@cmake --install build --prefix '$(PREFIX)'

# The .deb, the archive, and then the prefix that was, also where one of them fails.
package: all build/setup-package.stamp
	@rm -rf build/packages
	@before=$$(sed -n 's/^CMAKE_INSTALL_PREFIX:PATH=//p' build/CMakeCache.txt); rc=0; \
	for prefix in /usr /usr/local; do \
	  cmake build -DCMAKE_INSTALL_PREFIX=$$prefix && $(NINJA) -C build && cpack --config build/CPackConfig.cmake || \
	    { rc=1; break; }; \
	done; \
	cmake build -DCMAKE_INSTALL_PREFIX="$$before" && exit $$rc
	@rm -rf build/packages/_CPack_Packages
	@ls -l build/packages

build/setup.stamp: tools/packages.txt tools/setup
	@tools/setup tools/packages.txt
	@mkdir -p build && touch $@

build/setup-%.stamp: tools/packages-%.txt tools/setup
	@tools/setup $<
	@mkdir -p build && touch $@

build/build.ninja: build/setup.stamp
	$(CONFIGURE) --preset release -DCMAKE_CXX_COMPILER=$(CXX)
	@touch $@

build-asan/build.ninja: build/setup.stamp build/setup-dev.stamp
	$(CONFIGURE) --preset asan -DCMAKE_CXX_COMPILER=clang++-19
	@touch $@

build-clang/build.ninja: build/setup.stamp build/setup-dev.stamp
	$(CONFIGURE) --preset clang -DCMAKE_CXX_COMPILER=clang++-19
	@touch $@

MODEL :=
demo: all
	@$(if $(MODEL),true,tools/fetch_dragon)
	@build/dreampm make scenes/dragon-splatting.yaml --variant preview $(if $(MODEL),--model '$(MODEL)')

boxes: all
	@build/dreampm make scenes/drifting-boxes.yaml --variant preview

fill: all
	@tools/fetch_dragon
	@build/dreampm make scenes/flow-in-the-dragon.yaml --variant preview
	@build/dreampm info out/flow-in-the-dragon-preview --fill

PLAY := dam-break
play: all
	@build/dreampm play '$(PLAY)'

test: all build/setup-check.stamp
	@$(CTEST) --test-dir build -LE dragon

validate: all
	@build/dreampm validate --quick

test-dragon: all
	@tools/fetch_dragon
	@$(CTEST) --test-dir build -L dragon

# MODULES="base scene" narrows test-asan and test-clang to some modules; empty: all. What clang only reads then asks for the
# headers that a build writes.
MODULES ?=
empty :=
space := $(empty) $(empty)
test-asan: build-asan/build.ninja
	@$(NINJA) -C build-asan $(MODULES:%=test_%) $(if $(MODULES),dm_kernel_sources dm_physics)
	@$(CTEST) --test-dir build-asan $(if $(MODULES),-R '^($(subst $(space),|,$(strip $(MODULES)))|syntax)\.')

test-clang: build-clang/build.ninja
	@$(NINJA) -C build-clang $(if $(MODULES),dm_solver dm_validate_measure $(MODULES:%=test_%))
	@$(CTEST) --test-dir build-clang $(if $(MODULES),-R '^($(subst $(space),|,$(strip $(MODULES))))\.')

# libdreampm_cuda.so beside the command: `--backend cuda`.
cuda: build/setup-gpu.stamp
	@tools/build_cuda build/libdreampm_cuda.so

build/setup-gpu.stamp: tools/packages-gpu.txt tools/python_env tools/setup tools/cuda-requirements.txt
	@tools/setup tools/packages-gpu.txt
	@rm -rf build/cuda-env
	@tools/python_env build/cuda-env tools/cuda-requirements.txt
	@touch $@

# What clang reads as CUDA is a test of `make test`.
test-gpu: build/setup-gpu.stamp
	@start=$$(date +%s); tools/check_device hip & hip=$$!; \
	tools/build_cuda build/test-gpu/libdreampm_cuda.so && wait $$hip && echo "2 passed in $$(($$(date +%s) - start)).0s"

test-neon: build/setup.stamp build/setup-dev.stamp
	@tools/test_neon build-neon

test-tsan: build/setup.stamp
	@tools/tsan build-tsan

# Some of the targets, and how long each: in seconds or, with RUNS, in inputs. SEED: the same inputs each time.
TARGETS :=
SECONDS := 60
RUNS := 0
SEED := 0
fuzz: build-asan/build.ninja
	@$(NINJA) -C build-asan $(or $(TARGETS:%=fuzz_%),fuzz_targets)
	@tools/fuzz build-asan $(TARGETS) --seconds $(SECONDS) --runs $(RUNS) --seed $(SEED) --jobs $(TEST_JOBS)

build/setup-python.stamp: tools/packages-python.txt tools/python_env tools/setup python/requirements.txt
	@tools/setup tools/packages-python.txt
	@tools/python_env build/python-env
	@touch $@

# The same build, with the package in it from then on.
test-python: build/build.ninja build/setup-python.stamp
	@cmake build -DDM_PYTHON=ON -DPython_EXECUTABLE=$(CURDIR)/build/python-env/bin/python
	@$(NINJA) -C build dm_python_stub dreampm cuda_stand_in_$$(cat VERSION)
	@$(CTEST) --test-dir build -R '^python\.'

# Which Python the wheel is for: of 3.12 and newer one works with all of them.
WHEEL_PYTHON := $(PYTHON)
wheel_env := build/wheel-env-$(notdir $(WHEEL_PYTHON))
$(wheel_env)/ready.stamp: tools/packages-python.txt tools/python_env tools/setup python/requirements-wheel.txt
	@tools/setup tools/packages-python.txt
	@tools/python_env $(wheel_env) python/requirements-wheel.txt $(WHEEL_PYTHON)
	@touch $@

wheel: build/setup.stamp $(wheel_env)/ready.stamp
	@tools/wheel build $(wheel_env)

blender:
	@tools/blender_zip build

# Blender as a module of Python, in an environment of its own.
build/setup-blender.stamp: tools/packages-blender.txt tools/python_env tools/setup tests/blender/requirements.txt
	@tools/setup tools/packages-blender.txt
	@tools/python_env build/blender-env tests/blender/requirements.txt
	@touch $@

test-blender: all build/setup-blender.stamp
	@tools/blender_zip build
	@rm -rf build/blender-user
	@BLENDER_USER_RESOURCES=$(CURDIR)/build/blender-user DREAMPM_COMMAND=$(CURDIR)/build/dreampm \
	  build/blender-env/bin/python -m pytest -q -p no:cacheprovider tests/blender/in_blender

# Jobs of a farm by the programs that run farms; what they need serves these tests alone.
build/setup-farm.stamp: tools/packages-farm.txt tools/python_env tools/setup tests/farm/requirements.txt
	@tools/setup tools/packages-farm.txt
	@tools/python_env build/farm-env tests/farm/requirements.txt
	@touch $@

test-farm: all build/setup-farm.stamp
	@PATH=$(CURDIR)/build/farm-env/bin:$$PATH tests/farm/openjd.sh build/dreampm docs/guide/farm.md

test-slurm: all build/setup-slurm.stamp
	@tests/farm/slurm.sh build/dreampm

docs: build/setup-dev.stamp
	@mkdir -p build/docs
	@DM_VERSION=$$(cat VERSION) doxygen docs/Doxyfile
	@echo build/docs/html/index.html

TIDY := since HEAD
tidy: build/setup.stamp build/setup-dev.stamp
	@tools/tidy $(TIDY)

check: build/setup.stamp build/setup-check.stamp
	@tools/check_layers
	@tools/check_links
	@tools/check_words
	@tools/performance_chart --check
	@tools/wrap_prose
	@tools/check_format

format: build/setup.stamp build/setup-check.stamp
	@tools/wrap_prose --fix
	@tools/check_format --fix

clean:
	rm -rf build build-asan build-tsan build-clang build-neon build-tidy
