// SPDX-License-Identifier: MIT
//
// A program outside the project: reads the installed model, and shows that an Error crosses the
// border of the library as what it is.

#include <iostream>

#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"

int main() {
  const mmm_converter::KinematicModel model =
      mmm_converter::ReadMmmModel(mmm_converter::DataFile("models/mmm.xml"));
  const Eigen::Matrix3Xd p_WM =
      mmm_converter::MarkerPositions(model, mmm_converter::ZeroPosture(model));
  std::cout << model.name() << ": " << p_WM.cols() << " markers, " << model.num_joints()
            << " joints\n";
  try {
    mmm_converter::ReadMmmModel("/no/such/model.xml");
  } catch (const mmm_converter::Error& error) {
    std::cout << "as expected: " << error.what() << '\n';
    return 0;
  }
  std::cerr << "no Error for a model that does not exist\n";
  return 1;
}
