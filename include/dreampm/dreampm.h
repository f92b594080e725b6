// Everything that programs include.
#pragma once
#include "dreampm/error.h"
#include "dreampm/host.h"
#include "dreampm/image.h"
#include "dreampm/mesh.h"
#include "dreampm/particles.h"
#include "dreampm/pose.h"
#include "dreampm/render.h"
#include "dreampm/scene.h"
#include "dreampm/simulation.h"
#include "dreampm/surface.h"
#include "dreampm/vec.h"
#include "dreampm/version.h"
