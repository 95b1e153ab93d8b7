# Runs PROGRAM on a few episodes in FOLDER, which is removed before and after.
file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${PROGRAM} --episodes 40 --stores 3 --out ${FOLDER}
                RESULT_VARIABLE result)
file(REMOVE_RECURSE ${FOLDER})
if(NOT result EQUAL 0)
  message(FATAL_ERROR "campaign_scale: ${result}")
endif()
