"""What may fail while a service runs, line by line, and the tests that let it fail.

A line of the design stands on the left; each test on the right fails where it does not hold.
"""

import ast
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[2]
_ACCEPTANCE, _DOOR = "acceptance/operation", "integration/dashboard"
_SERVICE, _PARTS = "integration/operation", "unit/operation"

#: by what fails, files of tests, and names of tests in them
FAILURES: dict[str, tuple[tuple[str, str], ...]] = {
    "service killed": (
        (f"{_SERVICE}/test_kills.py", "test_all_is_there_once"),
        (f"{_DOOR}/test_running_service.py", "test_decisions_at_once_and_a_kill_in_between"),
        (f"{_DOOR}/test_two_operators.py", "test_a_proposal_is_decided_once"),
        (f"{_DOOR}/test_two_operators.py", "test_of_two_that_roll_back_one_wins"),
    ),
    "worker killed, out of memory": (
        (f"{_SERVICE}/test_workers.py", "test_workers_that_are_killed_are_followed_by_others"),
        (f"{_SERVICE}/test_workers.py", "test_a_twin_at_which_workers_end_is_left_alone"),
    ),
    "broker restarts, loses session or queue": (
        (f"{_SERVICE}/test_kills.py", "test_all_is_there_once"),
        (f"{_SERVICE}/test_broker.py", "test_a_broker_that_was_killed_is_found_again"),
        (f"{_SERVICE}/test_alarms.py", "test_packets_that_never_came_are_told_of"),
    ),
    "network cut for days": (
        (f"{_ACCEPTANCE}/test_half_open.py", "test_the_probe_finds_a_broker_that_brings_nothing"),
        (f"{_ACCEPTANCE}/test_half_open.py", "test_a_sender_whose_answers_are_lost_sends_again"),
        (f"{_SERVICE}/test_broker.py", "test_a_service_that_was_away_gets_what_was_sent"),
        (f"{_PARTS}/test_clock.py", "test_what_was_kept_while_the_network_was_away_is_believed"),
    ),
    "duplicate, out of order": (
        (f"{_SERVICE}/test_faulty_logger.py", "test_counts_are_as_scripted"),
        (f"{_PARTS}/test_packets.py", "test_a_packet_is_kept_once"),
        (f"{_PARTS}/test_sealing.py", "test_rows_do_not_hang_on_how_packets_arrived"),
    ),
    "late after sealing": (
        (f"{_PARTS}/test_sealing.py", "test_what_comes_after_its_row_is_late"),
        (f"{_SERVICE}/test_faulty_logger.py", "test_counts_are_as_scripted"),
    ),
    "logger clock jumps": (
        (f"{_PARTS}/test_clock.py", "test_a_clock_that_jumps_ahead_is_refused_until_it_is_set"),
        (f"{_PARTS}/test_sealing.py", "test_a_clock_that_runs_back_changes_no_row"),
        (f"{_SERVICE}/test_alarms.py", "test_a_clock_that_is_ahead_is_told_of"),
    ),
    "server clock jumps": (
        (f"{_ACCEPTANCE}/test_jumps.py", "test_a_clock_of_the_service_that_is_set_changes_no_row"),
        (f"{_PARTS}/alarms/test_alarm_life.py", "test_delays_go_by_no_clock_that_is_set"),
        (f"{_PARTS}/notices/test_notices.py", "test_a_clock_that_is_set_back_holds_no_message"),
    ),
    "unreadable packet": (
        (f"{_PARTS}/test_sealing.py", "test_what_cannot_be_used_is_refused_before_it_is_kept"),
        (f"{_SERVICE}/test_faulty_logger.py", "test_counts_are_as_scripted"),
        (
            f"{_DOOR}/test_pages.py",
            "test_data_tells_of_gaps_refusals_and_of_loss_that_cannot_be_told",
        ),
    ),
    "unknown channel, changed unit": (
        (f"{_PARTS}/test_sealing.py", "test_units_of_a_payload_are_turned_into_those_of_the_model"),
    ),
    "sensor silent or stuck": (
        (f"{_SERVICE}/test_alarms.py", "test_a_sensor_that_is_silent_is_named"),
        (f"{_PARTS}/alarms/test_sensor_quality.py", "test_what_is_wrong_is_told_once"),
    ),
    "disk below a share, or full": (
        (f"{_SERVICE}/test_alarms.py", "test_a_disk_that_is_nearly_full_is_told_of"),
        (
            f"{_SERVICE}/test_workers.py",
            "test_long_steps_wait_for_room_and_go_on_by_themselves",
        ),
        (f"{_PARTS}/test_archive.py", "test_days_wait_for_room_and_what_is_old_makes_it"),
        (f"{_ACCEPTANCE}/test_full_disk.py", "test_what_can_wait_waits_where_little_is_free"),
        (f"{_ACCEPTANCE}/test_full_disk.py", "test_a_sender_is_told_to_wait_and_nothing_is_lost"),
        (f"{_ACCEPTANCE}/test_full_disk.py", "test_a_broker_holds_what_cannot_be_kept"),
        (f"{_ACCEPTANCE}/test_full_disk.py", "test_a_worker_goes_on_where_there_was_no_room"),
        (f"{_ACCEPTANCE}/test_full_disk.py", "test_an_alarm_waits_for_room"),
    ),
    "PostgreSQL away": (
        (
            f"{_ACCEPTANCE}/test_postgresql_away.py",
            "test_rows_are_kept_and_played_when_it_is_there_again",
        ),
        (
            f"{_ACCEPTANCE}/test_postgresql_away.py",
            "test_a_server_that_goes_away_in_the_middle_of_a_step",
        ),
    ),
    "twin slower than data": (
        (f"{_SERVICE}/test_alarms.py", "test_a_twin_that_is_not_played_lags_and_is_told_why"),
        (f"{_ACCEPTANCE}/test_fleet.py", "test_rows_of_others_are_played_while_one_is_diagnosed"),
        (f"{_DOOR}/test_api.py", "test_a_full_disk_is_told_and_nothing_is_kept"),
    ),
    "diagnosis fails": (
        (f"{_ACCEPTANCE}/test_jumps.py", "test_a_diagnosis_that_fails_is_asked_again_later"),
    ),
    "mail or hook down": (
        (f"{_PARTS}/notices/test_notices.py", "test_a_message_is_sent_until_it_arrives"),
        (
            f"{_PARTS}/notices/test_notices.py",
            "test_after_a_day_it_is_given_up_and_stays_on_the_list",
        ),
    ),
    "slow browser": (
        (
            f"{_DOOR}/test_stream.py",
            "test_a_browser_that_reads_slowly_is_told_of_all_rows_in_one_message",
        ),
    ),
    "upgrade": (
        (f"{_ACCEPTANCE}/test_upgrade.py", "test_a_repository_of_before_opens_with_its_history"),
        ("unit/twin/test_repository_places.py", "test_a_newer_repository_is_refused"),
    ),
    "no room for a year": (
        (
            f"{_DOOR}/test_pages.py",
            "test_data_tells_what_a_year_takes_and_that_there_is_no_room_for_it",
        ),
        (
            f"{_SERVICE}/test_serve_check.py",
            "test_a_year_of_two_twins_that_does_not_fit_is_told",
        ),
        (f"{_PARTS}/test_forecast.py", "test_a_year_is_as_calculated_by_hand"),
    ),
}


@pytest.mark.parametrize("what", FAILURES)
def test_what_may_fail_is_let_fail(what: str) -> None:
    for file, name in FAILURES[what]:
        content = ast.parse((TESTS / file).read_text("utf-8"))
        assert name in {one.name for one in content.body if isinstance(one, ast.FunctionDef)}, file
