// All public headers of models: systems and their factory.
#pragma once

#include "models/constants.hpp"
#include "models/dynamics/dynamics.hpp"
