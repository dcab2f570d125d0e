"""Whatever is sent, the API answers as its description says."""

import hypothesis
import pytest
import schemathesis
from schemathesis.checks import not_a_server_error
from schemathesis.config import SchemathesisConfig
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from rga.dashboard.app import app_of
from rga.operation.service import Service

#: what is asked of every answer
CHECKS = (
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
)
#: calls of each path, and of each in the longer form
CALLS, MANY_CALLS = 8, 300


def check_answers(service: Service, calls: int) -> None:
    """Send drawn calls to every path of the API, and check what it answers."""
    # Streams do not end by themselves.
    app = app_of(service, is_ending=lambda: True)
    config = SchemathesisConfig()
    schema = schemathesis.openapi.from_dict(app.openapi(), config=config)
    headers = {"Host": "127.0.0.1"}
    schema.app = app
    for found in schema.get_all_operations():
        operation = found.ok()

        @hypothesis.given(case=operation.as_strategy())
        @hypothesis.settings(
            max_examples=calls,
            deadline=None,
            derandomize=True,
            database=None,
            suppress_health_check=[*hypothesis.HealthCheck],
        )
        def check(case: schemathesis.Case) -> None:
            if "twin" in case.path_parameters and len(str(case.query)) % 4:
                # A name that is drawn is that of no twin.
                case.path_parameters["twin"] = "east"
            case.call_and_validate(headers=headers, checks=[*CHECKS])

        check()


def test_answers_are_as_described(service: Service) -> None:
    check_answers(service, CALLS)


@pytest.mark.thorough
def test_many_answers_are_as_described(service: Service) -> None:
    check_answers(service, MANY_CALLS)
