// name: denied-grants-that-cut
// kind: path
// description: Which DENY lines keep a kind of data from a leak that it would go on to, if they were not there?
// param otherwise: boolean, also leaks that data of the kind gets to anyway; takes longer, default false
// param robot: robot, only what begins, ends or would get out at this robot; all robots if it is empty, default ""
// returns robot: string, name of the robot of the start
// returns category: string, the kind of data that is at the start of the denied flow
// returns start: string, name of the element that has it
// returns end: string, name of the element that the DENY keeps it from
// returns leak: string, name of the first leak on the way on, if nothing is made of the data before
// returns denied_by: list of string, file:line of the DENY
// returns allowed_by: string, file:line of the ALLOW that it takes back; empty where the DENY takes a name out of a wildcard
// returns reached: boolean, whether data of that kind gets to the leak anyway
// returns path: list of string, names on a shortest path from the start to the leak
// returns end_robot: string, name of the robot of the end, which may be another one
// returns leak_robot: string, name of the robot of the leak, which may be another one
// order: robot, category, start, end, end_robot, leak, leak_robot
MATCH (c:DataCategory)<-[:SOURCE_OF|DERIVES]-(:Element)
WITH collect(DISTINCT c.name) AS emitted
MATCH (leak:Element) WHERE size(leak.leaks) > 0  // by a label, or since it is a display or another system
WITH leak, emitted
UNWIND [k IN leak.leaks WHERE k IN emitted] AS category
WITH leak, category, EXISTS { (leak)<-[:TO]-(:Finding {kind: 'disclosure', category: category}) } AS reached
WHERE $otherwise OR NOT reached
CALL (leak, category) {
  RETURN leak AS b, [leak.name] AS way
UNION
  MATCH p = ANY SHORTEST (b:Element WHERE EXISTS { ()-[:FLOWS_TO {decision: 'deny'}]->(b) })
            ((x)-[f:FLOWS_TO WHERE coalesce(f.decision, 'allow') <> 'deny' AND NOT category IN coalesce(f.stops, [])
                               AND NOT category IN coalesce(x.stops + x.leaks, [])]->()){1,}(leak)
  RETURN b, [b.name] + [r IN relationships(p)  // the two sides of a wildcard are shown as one
                        WHERE r.role IS NULL OR r.role <> 'matches' OR startNode(r).name <> endNode(r).name
                        | endNode(r).name] AS way
}
MATCH (a:Element)-[d:FLOWS_TO {decision: 'deny'}]->(b)
WHERE ($robot = '' OR $robot IN [a.robot, b.robot, leak.robot])
  AND (NOT category IN coalesce(a.stops, [])
       AND EXISTS { ()-[i:FLOWS_TO]->(a) WHERE category IN i.passes OR category IN i.begins OR category IN i.made }
    OR EXISTS { (a)-[:DERIVES_FROM {category: category}]->(:Element) }
    OR category IN a.begins
       AND any(name IN coalesce(COLLECT { MATCH (a)-[s:SOURCE_OF]->(:DataCategory {name: category})
                                          RETURN s.through ORDER BY coalesce(s.tier, 2) DESC,
                                                            coalesce(s.specificity, 1000000) DESC LIMIT 1 }[0], ['*'])
               WHERE CASE WHEN name CONTAINS '[' OR name CONTAINS '\\' THEN true  // such names are not looked into
                     ELSE b.name =~ '\\Q' + replace(replace(name, '*', '\\E.*\\Q'), '?', '\\E.\\Q') + '\\E' END))
RETURN a.robot AS robot, category, a.name AS start, b.name AS end, leak.name AS leak, d.denied_by AS denied_by,
       coalesce(d.file + ':' + d.line, '') AS allowed_by, reached, [a.name] + way AS path,
       b.robot AS end_robot, leak.robot AS leak_robot
ORDER BY robot, category, start, end, end_robot, leak, leak_robot
