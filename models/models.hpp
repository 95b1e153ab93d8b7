// All of the public headers of models: systems, and how to make one.
#pragma once

#include "models/constants.hpp"
#include "models/dynamics/dynamics.hpp"
